#pragma once
/// \file
/// A problem, solved: its states, its reports, and the files that the program would write.

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "karcher/problem/discrete_problem.hpp"
#include "karcher/problem/probes.hpp"
#include "karcher/solve/continuation.hpp"

namespace karcher {

class Solution {
 public:
  /// status converged: every load step is.
  const ContinuationReport& report() const { return report_; }
  bool converged() const { return report_.status == Status::converged; }
  /// The initial configuration, then the end of every load step, a failed last one included; complete on every rank.
  const std::vector<Configuration>& states() const { return states_; }
  const std::vector<Field>& fields() const { return model_->fields(); }
  const Functional& functional() const { return *model_->functional; }
  const std::vector<IterationRecord>& iterations() const { return iterations_; }

  /// Value of a field at a mesh point after the last load step. Not a number where the interpolation is not defined.
  /// \throws InputError for a point off the field's region
  template <class M>
  Point<M> at(FieldOf<M> field, const Vec3<double>& x) const {
    Point<M> p;
    const std::vector<double> value = value_at(field.index, x);
    for (int i = 0; i < M::ambient; ++i) p[i] = value[static_cast<std::size_t>(i)];
    return p;
  }
  std::vector<double> value_at(int field, const Vec3<double>& x) const;

  /// What `karcher run` writes: summary.json, iterations.csv, solution.pvd, report.html. Collective. \throws Error if a file cannot be written
  void save(const std::filesystem::path& directory) const;

 private:
  friend Solution solve(const Problem& problem, std::span<Observer* const> observers);
  std::shared_ptr<const Problem> problem_;
  std::shared_ptr<DiscreteProblem> model_;
  ContinuationReport report_;
  std::vector<Configuration> states_;
  std::vector<IterationRecord> iterations_;
};

/// Builds the problem and follows its load steps. Collective.
/// \throws InputError for what is wrong with it, before anything is solved; not converging is a result
Solution solve(const Problem& problem, std::span<Observer* const> observers = {});
/// The same with other load steps and solver options than the problem's own.
Solution solve(Problem problem, const ContinuationOptions& continuation, const SolverOptions& solver = {});

}  // namespace karcher
