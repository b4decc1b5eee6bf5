#pragma once
/// \file
/// What a run leaves behind while it goes on: table, iterations.csv, fields, summary, checkpoint.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "karcher/io/checkpoint.hpp"
#include "karcher/io/console_table.hpp"
#include "karcher/io/directory_lock.hpp"
#include "karcher/io/iterations.hpp"
#include "karcher/io/load_steps_file.hpp"
#include "karcher/io/page.hpp"
#include "karcher/io/probes_csv.hpp"
#include "karcher/io/summary.hpp"
#include "karcher/io/vtu.hpp"
#include "karcher/problem/discrete_problem.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

/// Seconds of a clock that never goes back, since the first call.
double seconds_now();

/// Writes the results of load steps. Lives on all ranks; rank 0 writes.
class Results : public Observer {
 public:
  Results(const Problem& problem, const DiscreteProblem& model, std::uint64_t identity, double setup_seconds);

  /// A new run: the directory, which is locked and emptied of an earlier run's results, the resolved problem, and the initial configuration as state 0. Collective.
  /// \throws InputError if the directory cannot be written to or another run has it
  void begin(const Configuration& initial);
  /// Goes on after the load steps of a checkpoint. Collective.
  void resume(const Checkpoint& checkpoint);
  void load_step_finished(const StepReport& report, const Configuration& u) override;
  /// Where sentences about doubtful results go besides the summary; each is said at the first load step and at the last one that it is true of.
  void warn_with(std::function<void(const std::string&)> warn) { warn_ = std::move(warn); }
  /// The last summary and the page. \param status of the whole run
  void finish(Status status, const std::string& reason);

  const Summary& summary() const { return summary_; }
  /// On rank 0: "replaces the results of ..." after begin(), where there were any; why there is no page after finish(), where it failed.
  const std::string& replaced() const { return replaced_; }
  const std::string& page_trouble() const { return page_trouble_; }
  const std::filesystem::path& directory() const { return problem_.output.directory; }
  std::filesystem::path checkpoint_file() const { return directory() / "checkpoint.bin"; }

 private:
  void write_state(int state, const Configuration& u, bool files);
  void measure(const Configuration& u);
  void doubt(LoadStepSummary& step, const Configuration& u, bool last);
  void update_times();
  /// The tables that grow with the load steps, with those that are finished.
  void open_tables();
  /// The summary so far without its load steps, for the checkpoint.
  std::string history();
  void write_load_step(const StepReport& report, const Configuration& u, const LoadStepSummary& step);

  const Problem& problem_;
  const DiscreteProblem& model_;
  std::uint64_t identity_;
  bool writer_;
  OutputSampler output_;
  std::optional<DirectoryLock> lock_;
  std::string replaced_, page_trouble_;
  std::function<void(const std::string&)> warn_;
  bool warned_ = false;  ///< of strains
  std::optional<LoadStepsFile> load_steps_;
  std::optional<ProbesCsv> probes_;
  std::optional<VtuSeries> vtu_;
  std::optional<PageStates> page_;
  Summary summary_;
  double start_ = 0, earlier_seconds_ = 0;
  double summary_due_ = 0;  ///< seconds_now() from which summary.json is written again
};

/// What must agree between a run and the run that continues it.
std::uint64_t identity(const Problem& problem, const DiscreteProblem& model);

}  // namespace karcher
