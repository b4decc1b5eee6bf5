#include "karcher/problem/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "karcher/io/atomic_file.hpp"
#include "karcher/io/earlier_results.hpp"
#include "karcher/problem/discretisation_error.hpp"
#include "karcher/problem/largest_strain.hpp"
#include "karcher/problem/probes.hpp"
#include "karcher/problem/topological_charge.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/together.hpp"
#include "karcher/version.hpp"

namespace karcher {

double seconds_now() {
  static const auto begin = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::uint64_t identity(const Problem& problem, const DiscreteProblem& model) {
  Identity id;
  id.add(model.fields());
  for (const std::string& text : problem.identity) id.add(text);
  return id.value();
}

Results::Results(const Problem& problem, const DiscreteProblem& model, std::uint64_t identity, double setup_seconds)
    : problem_(problem),
      model_(model),
      identity_(identity),
      writer_(model.layout->rank() == 0),
      output_(output_model(problem, model)),
      start_(seconds_now() - setup_seconds) {
  const Mesh& mesh = *model.discretisation.mesh;
  summary_.title = problem.title;
  summary_.version = version_string;
  summary_.mesh.cells = static_cast<long>(mesh.cells.size());
  summary_.mesh.nodes = static_cast<long>(mesh.nodes.size());
  summary_.mesh.order = mesh.order();
  for (const Field& f : model.fields()) summary_.unknowns += static_cast<long>(f.space->node_count()) * f.manifold->dim;
  summary_.free_unknowns = model.layout->free_dofs();
  summary_.ranks = model.layout->ranks();
  summary_.warnings = model.warnings;
  summary_.seconds.setup = setup_seconds;
}

void Results::begin(const Configuration& initial) {
  const double begin = seconds_now();
  together([&] {
    if (!writer_) return;
    lock_.emplace(directory());
    replaced_ = remove_earlier_results(directory());
    if (!problem_.resolved.empty()) write_atomically(directory() / "problem.resolved.toml", problem_.resolved);
    open_tables();
    if (problem_.output.vtu) vtu_.emplace(directory());
    if (problem_.output.report) page_.emplace(directory(), output_model(problem_, model_));
  });
  write_state(0, initial, true);
  together([&] {
    if (writer_) write_checkpoint(checkpoint_file(), {.configuration = initial, .summary = history()}, model_.fields(), identity_);
  });
  summary_.seconds.output += seconds_now() - begin;
}

void Results::resume(const Checkpoint& checkpoint) {
  together([&] {
    const Summary earlier = summary_from_json(checkpoint.summary, checkpoint_file().string());
    summary_.load_steps = read_load_steps(directory());
    if (summary_.load_steps.size() < static_cast<std::size_t>(checkpoint.load_step))
      throw InputError(fmt::format("{} holds {} load steps, but the checkpoint was written after {}.", (directory() / "load_steps.jsonl").string(),
                                   summary_.load_steps.size(), checkpoint.load_step));
    summary_.load_steps.resize(static_cast<std::size_t>(checkpoint.load_step));
    summary_.work = earlier.work;
    summary_.energy = earlier.energy;
    summary_.energies = earlier.energies;
    summary_.parts = earlier.parts;
    summary_.errors = earlier.errors;
    const double setup = summary_.seconds.setup;
    summary_.seconds = earlier.seconds;
    summary_.seconds.setup += setup;
    earlier_seconds_ = earlier.seconds.total;
    if (!writer_) return;
    lock_.emplace(directory());
    remove_unfinished_files(directory());
    if (!problem_.resolved.empty()) write_atomically(directory() / "problem.resolved.toml", problem_.resolved);
    open_tables();
    if (problem_.output.vtu) {
      vtu_.emplace(directory());
      vtu_->resume(checkpoint.load_step + 1);
    }
    if (problem_.output.report) page_.emplace(directory(), output_model(problem_, model_), checkpoint.load_step + 1);
  });
}

void Results::open_tables() {
  load_steps_.emplace(directory(), summary_.load_steps);
  probes_.emplace(directory() / "probes.csv", summary_.load_steps);
}

std::string Results::history() {
  std::vector<LoadStepSummary> steps;
  std::swap(steps, summary_.load_steps);
  std::string text = to_json(summary_);
  std::swap(steps, summary_.load_steps);
  return text;
}

void Results::measure(const Configuration& u) {
  const Functional& f = *model_.functional;
  const Evaluation e = f.energy(u);
  const bool defined = first_text(e.failure ? e.failure->sentence() : "").empty();
  std::vector<double> sums = e.terms;
  for (const auto& term : f.terms()) {
    const std::vector<double> parts = term->part_energies(u);
    sums.insert(sums.end(), parts.begin(), parts.end());
  }
  sum_over_ranks(sums);
  // A sum over some of the cells would be a wrong number.
  if (!defined) std::fill(sums.begin(), sums.end(), std::numeric_limits<double>::quiet_NaN());
  summary_.energy = 0;
  summary_.energies.clear();
  summary_.parts.clear();
  std::size_t k = 0;
  for (const std::string& name : model_.term_names) {
    summary_.energy += sums[k];
    summary_.energies.emplace_back(name, sums[k++]);
  }
  for (std::size_t i = 0; i < f.terms().size(); ++i)
    for (const std::string& part : f.terms()[i]->part_names()) summary_.parts[model_.term_names[i]].emplace_back(part, sums[k++]);
}

void Results::write_state(int state, const Configuration& u, bool files) {
  if (!problem_.output.vtu && !problem_.output.report) return;
  if (!files) return;
  std::vector<double> energies = output_.cell_energies(*model_.functional, u);
  sum_over_ranks(energies);
  together([&] {
    if (!writer_) return;
    const std::vector<OutputPart> parts = output_.sample(u, energies);
    if (vtu_) vtu_->write(state, u.t, parts);
    if (page_) page_->write(state, u.t, parts, summary_.energies);
  });
}

/// What makes the state doubtful although it may be a minimum. u: complete.
void Results::doubt(LoadStepSummary& step, const Configuration& u, bool last) {
  step.topological_charge = topological_charges(model_, u);
  step.largest_strain = largest_strain(model_, u);
  if (!step.largest_strain) return;
  const std::string sentence = strain_warning(model_, *step.largest_strain);
  if (sentence.empty()) return;
  step.warnings.push_back(sentence);
  if (warn_ && (!warned_ || last)) warn_(sentence);
  warned_ = true;
}

void Results::update_times() { summary_.seconds.total = earlier_seconds_ + seconds_now() - start_; }

void Results::load_step_finished(const StepReport& report, const Configuration& local) {
  const double begin = seconds_now();
  Configuration u = local;
  complete(*model_.layout, u);
  measure(u);
  summary_.errors = errors_against_exact(problem_, model_, u);
  LoadStepSummary step = summarize(report);
  together([&] { step.probes = probe_values(problem_, model_, u); });
  const bool last = report.status != Status::converged || u.t == problem_.continuation.to;
  doubt(step, u, last);
  summary_.load_steps.push_back(step);
  summary_.work += report.work;
  summary_.seconds.assembly += report.phases.assembly;
  summary_.seconds.factorisation += report.phases.factorisation;
  summary_.seconds.solve += report.phases.solve;
  write_state(report.load_step, u, last || report.load_step % problem_.output.every == 0);
  summary_.seconds.output += seconds_now() - begin;
  update_times();
  // Until the end, what stands there is the summary of a run that was cut off after this load step.
  summary_.status = report.status == Status::converged ? Status::interrupted : report.status;
  summary_.reason = fmt::format("Load step {} (t = {:.6g}) ended: {}", report.load_step, report.t, report.reason);
  summary_.peak_memory_mb = sum_over_ranks(peak_memory_mb());
  together([&] {
    if (writer_) write_load_step(report, u, step);
  });
}

void Results::write_load_step(const StepReport& report, const Configuration& u, const LoadStepSummary& step) {
  load_steps_->add(step);
  probes_->add(report.load_step, step);
  // The summary holds all load steps, so writing it after each of ten thousand would cost as the square of their number: it takes a twentieth of the time at most.
  if (const double now = seconds_now(); now >= summary_due_) {
    write_summary(directory() / "summary.json", summary_);
    summary_due_ = now + 20 * (seconds_now() - now);
  }
  if (report.status != Status::converged) return;
  const Checkpoint checkpoint{report.load_step, report.next_increment, report.largest_gradient, u, history()};
  write_checkpoint(checkpoint_file(), checkpoint, model_.fields(), identity_);
}

void Results::finish(Status status, const std::string& reason) {
  summary_.status = status;
  summary_.reason = reason;
  const double begin = seconds_now();
  summary_.peak_memory_mb = sum_over_ranks(peak_memory_mb());
  update_times();
  together([&] {
    if (!writer_) return;
    write_summary(directory() / "summary.json", summary_);
    if (!problem_.output.report) return;
    // The results are whole without it, and `karcher view` makes it again.
    try {
      write_page(directory());
    } catch (const std::exception& error) {
      page_trouble_ = error.what();
    }
    summary_.seconds.output += seconds_now() - begin;
    update_times();
    write_summary(directory() / "summary.json", summary_);
  });
}

}  // namespace karcher
