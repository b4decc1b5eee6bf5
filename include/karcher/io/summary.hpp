#pragma once
/// \file
/// Summary: what summary.json holds, key by key (docs/results.md), and how it is written and read back.
///
/// Every number reads back to the same double. JSON knows no NaN and no infinity: such numbers are written as null and read back as NaN; a count that
/// is unknown (negative_eigenvalues = -1) is null, too.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "karcher/math/tensor.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

/// Energies of the terms in the order of the problem file.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// The largest strain of an energy that is made for small ones (QuantityInfo::small_up_to).
struct LargestStrain {
  std::string energy;
  double value = 0;
  Vec3<double> place{};  ///< middle of the cell, on the mesh
};

struct LoadStepSummary {
  double t = 0;
  Status status = Status::failed;
  int iterations = 0;
  double energy = 0, gradient_norm = 0;
  int negative_eigenvalues = -1;  ///< -1: not known
  int neutral_eigenvalues = 0;
  std::map<std::string, std::vector<double>> probes;
  double seconds = 0;
  std::string reason;  ///< one sentence
  std::vector<std::string> warnings;
  std::optional<LargestStrain> largest_strain;
  std::map<std::string, double> topological_charge;  ///< by field
  WorkCounts work;
};

struct Summary {
  std::string title, version;
  Status status = Status::failed;
  struct {
    long cells = 0, nodes = 0;
    int order = 1;
  } mesh;
  long unknowns = 0, free_unknowns = 0;
  int ranks = 1;
  double energy = 0;
  NamedNumbers energies;                      ///< names must differ: see distinct_names
  std::map<std::string, NamedNumbers> parts;  ///< term -> its parts, where the term can tell them apart
  std::vector<LoadStepSummary> load_steps;
  struct Error {
    double l2 = 0, h1 = 0;
  };
  std::map<std::string, Error> errors;  ///< field -> distance to [exact]; empty without [exact]
  struct {
    double total = 0, assembly = 0, factorisation = 0, solve = 0, output = 0, setup = 0;
  } seconds;
  double peak_memory_mb = 0;          ///< sum over the ranks
  std::string reason;                 ///< one sentence: what was reached
  std::vector<std::string> warnings;  ///< about the problem and its start; those about results are with their load step
  WorkCounts work;                    ///< over all load steps
};

/// A finished load step as the summary tells it; probes are added by the caller.
LoadStepSummary summarize(const StepReport& report);

/// Terms of the same name are told apart: "harmonic", "harmonic-2", ...
std::vector<std::string> distinct_names(std::vector<std::string> names);

std::string to_json(const Summary& summary);
/// A load step in one line, with the keys that it has in the summary.
std::string to_json_line(const LoadStepSummary& step);
/// \throws InputError naming `source`
LoadStepSummary load_step_from_json(std::string_view text, const std::string& source);
/// \throws InputError naming `source` where the text is not a summary (syntax, missing key, wrong type).
Summary summary_from_json(const std::string& text, const std::string& source);

/// Atomically (atomic_file.hpp): readable at any moment while the program runs.
void write_summary(const std::filesystem::path& file, const Summary& summary);
Summary read_summary(const std::filesystem::path& file);

/// Largest resident memory of this process so far, in MB (10^6 bytes).
double peak_memory_mb();

}  // namespace karcher
