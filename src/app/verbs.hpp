#pragma once
/// \file
/// The verbs of the program. Each returns the exit code: 0 solved, 1 not converged, 130 interrupted; errors leave as exceptions (main.cpp).

#include <filesystem>
#include <string>
#include <vector>

#include "app/problem.hpp"

namespace karcher::app {

struct RunOptions {
  std::filesystem::path file;
  ReadOptions read;
  bool quiet = false;
  bool resume = false;
};
int run(const RunOptions& options);

struct EvaluateOptions {
  std::filesystem::path file;
  ReadOptions read;
  bool json = false;
};
int evaluate(const EvaluateOptions& options);

struct CheckOptions {
  std::filesystem::path file;
  ReadOptions read;
  bool derivatives = false;
};
int check(const CheckOptions& options);

struct ConvergeOptions {
  std::filesystem::path file;
  ReadOptions read;
  int levels = 3;
  std::string start = "prolonged";  ///< or "initial"
  bool json = false;
  bool quiet = false;
};
int converge(const ConvergeOptions& options);

int list(const std::string& what);
int doc(const std::string& key);
int version();
/// Copies an example. \param name of the new directory
int make_new(const std::string& name, const std::string& example);

/// Directory of the examples: KARCHER_EXAMPLES, else beside a program that was built, else installed. \throws Error if there is none
std::filesystem::path examples_directory();

}  // namespace karcher::app
