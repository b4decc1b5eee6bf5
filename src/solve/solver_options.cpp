#include <fmt/format.h>

#include <limits>

#include "karcher/solve/minimize.hpp"
#include "solve/subproblems.hpp"

namespace karcher {
namespace {

std::string known(const std::string& key, const std::string& value, const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& n : names) {
    if (value == n) return {};
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", n);
  }
  return fmt::format("The solver has no {} \"{}\"; it has {}.", key, value, list);
}

}  // namespace

std::vector<std::string> SolverOptions::methods() { return {"trust-region", "gradient-flow"}; }
std::vector<std::string> SolverOptions::subproblems() {
  std::vector<std::string> names;
  for (const SubproblemKind& kind : karcher::subproblems()) names.push_back(kind.name);
  return names;
}
std::vector<std::string> SolverOptions::norms() { return {"mass"}; }

std::vector<std::string> SolverOptions::validate() const {
  std::vector<std::string> wrong;
  const auto add = [&](std::string sentence) {
    if (!sentence.empty()) wrong.push_back(std::move(sentence));
  };
  add(known("method", method, methods()));
  add(known("subproblem", subproblem, subproblems()));
  add(known("norm", norm, norms()));
  if (!(gradient_tolerance >= 0 && gradient_tolerance < 1)) add(fmt::format("gradient_tolerance must be in [0, 1), but is {}.", gradient_tolerance));
  if (!(absolute_gradient_tolerance >= 0))
    add(fmt::format("absolute_gradient_tolerance must not be negative, but is {}.", absolute_gradient_tolerance));
  if (!(step_tolerance >= 0)) add(fmt::format("step_tolerance must not be negative, but is {}.", step_tolerance));
  if (max_iterations < 0) add(fmt::format("max_iterations must not be negative, but is {}.", max_iterations));
  if (!(initial_radius >= 0 && initial_radius < std::numeric_limits<double>::infinity()))
    add(fmt::format("initial_radius must be 0 (chosen) or positive, but is {}.", initial_radius));
  if (max_corrections < 0) add(fmt::format("max_corrections must not be negative, but is {}.", max_corrections));
  return wrong;
}

}  // namespace karcher
