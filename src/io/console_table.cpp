#include "karcher/io/console_table.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace karcher {
namespace {

constexpr const char* columns = "{:>6} {:>20} {:>12} {:>12} {:>12} {:>12} {:>10}  {}\n";

/// Columns of the terminal; a longer transient line would wrap and could not be erased.
std::size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// A number of the table, or nothing where there is nothing to tell.
std::string cell(double value, bool shown = true) { return shown ? fmt::format("{:.4e}", value) : std::string(); }

std::string share(double part, double total) { return total > 0 ? fmt::format("{:5.1f} %", 100 * part / total) : std::string(); }

std::string counted(long n, const char* one, const char* many) { return fmt::format("{} {}", n, n == 1 ? one : many); }

}  // namespace

ConsoleTable::ConsoleTable(std::FILE* out, int steps, bool terminal) : out_(out), steps_(steps), terminal_(terminal) {}

ConsoleTable::~ConsoleTable() { erase_transient(); }

void ConsoleTable::erase_transient() {
  if (transient_shown_) std::fputs("\r\x1b[K", out_);
  transient_shown_ = false;
}

void ConsoleTable::transient(const std::string& text) {
  if (!terminal_) return;
  erase_transient();
  std::fputs(text.substr(0, terminal_width() - 1).c_str(), out_);
  std::fflush(out_);
  transient_shown_ = true;
}

void ConsoleTable::line(const std::string& text) {
  erase_transient();
  fmt::print(out_, "{}\n", text);
  std::fflush(out_);
}

std::string ConsoleTable::time_left(int load_step) const {
  constexpr double worth_telling = 5;
  if (steps_ == 0 || ended_ == 0) return {};
  const double left = seconds_ / ended_ * (steps_ - load_step + 1);
  if (left < worth_telling) return {};
  return left < 100    ? fmt::format("; about {:.0f} s left", left)
         : left < 6000 ? fmt::format("; about {:.0f} min left", left / 60)
                       : fmt::format("; about {:.1f} h left", left / 3600);
}

void ConsoleTable::load_step_begins(int load_step, double t) {
  erase_transient();
  fmt::print(out_, "\nLoad step {}{}, t = {:.6g}{}\n", load_step, steps_ > 0 ? fmt::format(" of {}", steps_) : std::string(), t,
             time_left(load_step));
  fmt::print(out_, fmt::runtime(columns), "iter", "energy", "|gradient|", "|step|", "radius", "shift", "ratio", "");
  std::fflush(out_);
}

void ConsoleTable::iteration(const IterationRecord& r) {
  erase_transient();
  const bool stepped = r.iteration > 0 || r.step_norm > 0;  // the record of a starting point has no step
  std::string remark = stepped && !r.accepted ? "rejected" : "";
  if (!r.note.empty()) remark += (remark.empty() ? "" : ": ") + r.note;
  std::string row =
      fmt::format(fmt::runtime(columns), r.iteration, fmt::format("{:.12e}", r.energy), cell(r.gradient_norm), cell(r.step_norm, stepped),
                  cell(r.radius, r.radius > 0), cell(r.shift, r.shift > 0), stepped ? fmt::format("{:.3f}", r.ratio) : "", remark);
  row.erase(row.find_last_not_of(" \n") + 1);
  fmt::print(out_, "{}\n", row);
  std::fflush(out_);
  transient(fmt::format("  iteration {} of load step {}, {:.1f} s ...", r.iteration + 1, r.load_step, r.seconds));
}

void ConsoleTable::load_step_finished(const StepReport& report, const Configuration&) {
  erase_transient();
  ++ended_;
  seconds_ += report.seconds;
  fmt::print(out_, "{} after {}, {:.2f} s. {}\n", name(report.status), counted(report.iterations, "iteration", "iterations"), report.seconds,
             report.reason);
  for (const std::string& warning : report.warnings) fmt::print(out_, "warning: {}\n", warning);
  std::fflush(out_);
}

std::string final_report(const Summary& s) {
  std::string text;
  text += fmt::format("\n{}\n{}{}\n\n", s.title.empty() ? "Result" : s.title, name(s.status), s.reason.empty() ? "" : ": " + s.reason);
  text += fmt::format("  {:<24} {} cells of order {}, {} nodes\n", "mesh", s.mesh.cells, s.mesh.order, s.mesh.nodes);
  text += fmt::format("  {:<24} {} ({} free) on {}\n", "unknowns", s.unknowns, s.free_unknowns, counted(s.ranks, "rank", "ranks"));
  text += fmt::format("  {:<24} {:.12g}\n", "energy", s.energy);
  for (const auto& [term, energy] : s.energies) {
    text += fmt::format("    {:<22} {:.12g}\n", term, energy);
    const auto parts = s.parts.find(term);
    if (parts == s.parts.end()) continue;
    for (const auto& [part, value] : parts->second) text += fmt::format("      {:<20} {:.12g}\n", part, value);
  }
  for (const auto& [field, e] : s.errors) text += fmt::format("  {:<24} L2 {:.6e}   H1 {:.6e}\n", "error of " + field, e.l2, e.h1);

  if (!s.load_steps.empty()) {
    text += fmt::format("\n  {:>4} {:>10} {:>14} {:>10} {:>20} {:>12} {:>10} {:>9}\n", "step", "t", "status", "iterations", "energy", "|gradient|",
                        "neg. eig.", "seconds");
    int k = 0;
    for (const LoadStepSummary& step : s.load_steps)
      text += fmt::format("  {:>4} {:>10.6g} {:>14} {:>10} {:>20.12e} {:>12.4e} {:>10} {:>9.2f}\n", ++k, step.t, name(step.status), step.iterations,
                          step.energy, step.gradient_norm, step.negative_eigenvalues < 0 ? "unknown" : std::to_string(step.negative_eigenvalues),
                          step.seconds);
    const LoadStepSummary& end = s.load_steps.back();
    if (const auto& strain = end.largest_strain)
      text += fmt::format("\n  {:<24} {:.3g} ({}), around ({:.4g}, {:.4g}, {:.4g})\n", "largest strain", strain->value, strain->energy,
                          strain->place[0], strain->place[1], strain->place[2]);
    for (const auto& [field, charge] : end.topological_charge) text += fmt::format("  {:<24} {:.10g}\n", "topological charge of " + field, charge);
    std::string probes;
    for (const auto& [probe, values] : s.load_steps.back().probes) {
      probes += fmt::format("  {:<24}", probe);
      for (const double x : values) probes += fmt::format(" {:.10g}", x);
      probes += '\n';
    }
    if (!probes.empty()) text += "\n  probes at the end\n" + probes;
  }

  const auto& w = s.seconds;
  const double other = std::max(0.0, w.total - w.assembly - w.factorisation - w.solve - w.output - w.setup);
  const std::pair<const char*, double> phases[] = {{"set-up", w.setup}, {"assembly", w.assembly}, {"factorisation", w.factorisation},
                                                   {"solve", w.solve},  {"output", w.output},     {"other", other}};
  text += '\n';
  for (const auto& [phase, seconds] : phases) text += fmt::format("  {:<24} {:>9.2f} s {}\n", phase, seconds, share(seconds, w.total));
  text += fmt::format("  {:<24} {:>9.2f} s\n", "total", w.total);
  text += fmt::format("  {:<24} {}, {}, {}, {}, {}\n", "work", counted(s.work.factorisations, "factorisation", "factorisations"),
                      counted(s.work.hessians, "Hessian", "Hessians"), counted(s.work.gradients, "gradient", "gradients"),
                      counted(s.work.energies, "energy", "energies"), counted(s.work.solves, "solve", "solves"));
  text += fmt::format("  {:<24} {:.0f} MB\n", "peak memory", s.peak_memory_mb);
  return text;
}

}  // namespace karcher
