#pragma once
/// \file
/// The table on the console while a problem is solved, and the report at its end.

#include <cstdio>
#include <string>

#include "karcher/io/summary.hpp"
#include "karcher/solve/report.hpp"

namespace karcher {

/// One aligned row per iteration, a headline per load step. On a terminal a last, transient line tells what is going on; elsewhere (a file, a pipe)
/// only lasting lines are written, so logs stay clean.
class ConsoleTable : public Observer {
 public:
  /// \param steps number of load steps, 0 if not known beforehand. Make one on the rank that talks only.
  ConsoleTable(std::FILE* out, int steps, bool terminal);
  ~ConsoleTable() override;
  ConsoleTable(const ConsoleTable&) = delete;
  ConsoleTable& operator=(const ConsoleTable&) = delete;

  void load_step_begins(int load_step, double t) override;
  void iteration(const IterationRecord& record) override;
  void load_step_finished(const StepReport& report, const Configuration& u) override;
  /// A lasting line between the rows ("results written to ...").
  void line(const std::string& text);
  /// Replaces the transient line; does nothing when `out` is no terminal.
  void transient(const std::string& text);

 private:
  void erase_transient();
  /// "; about 3 min left", by the mean of the load steps that have ended; nothing where their number is not known or there is little to wait for.
  std::string time_left(int load_step) const;

  std::FILE* out_;
  int steps_;
  bool terminal_;
  bool transient_shown_ = false;
  int ended_ = 0;       ///< load steps
  double seconds_ = 0;  ///< that they took
};

/// Sizes, energies, load steps, time by phase, work, the reason: the whole summary for a reader. Several lines, each ended by a newline.
std::string final_report(const Summary& summary);

}  // namespace karcher
