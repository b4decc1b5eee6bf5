#include <fmt/format.h>

#include <algorithm>

#include "app/launch.hpp"
#include "app/signals.hpp"
#include "app/verbs.hpp"
#include "karcher/io/run_log.hpp"
#include "karcher/problem/reference_energy.hpp"
#include "karcher/problem/results.hpp"
#include "karcher/solve/continuation.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"

namespace karcher::app {
namespace {

int exit_code(Status status) {
  switch (status) {
    case Status::converged:
      return 0;
    case Status::interrupted:
      return 130;
    default:
      return 1;
  }
}

/// What was reached, in one sentence.
std::string outcome(const ContinuationReport& report, int earlier, int planned) {
  if (report.steps.empty()) return "No load step was made.";
  const StepReport& last = report.steps.back();
  const auto steps = static_cast<int>(report.steps.size()) + earlier;
  std::string text;
  if (planned == 1 && steps == 1)
    text = last.reason;
  else
    text = fmt::format("{} load step{}, the last at t = {:.6g}: {}", steps, steps == 1 ? "" : "s", last.t, last.reason);
  return text;
}

}  // namespace

int run(const RunOptions& options) {
  catch_interrupts();
  const bool talks = world_rank() == 0;
  Problem problem;
  std::shared_ptr<const Mesh> mesh;
  together([&] {
    problem = read_problem(options.file, options.read);
    check_solvable(problem);
    mesh = build_mesh(problem);
  });
  DiscreteProblem model = build(problem, mesh);
  Configuration u = model.discretisation.start;
  rehearse(problem, model);
  const std::uint64_t id = identity(problem, model);

  Checkpoint checkpoint;
  Results results(problem, model, id, seconds_now());
  if (options.resume) {
    together([&] { checkpoint = read_checkpoint(results.checkpoint_file(), model.fields(), id); });
    u = checkpoint.configuration;
  }
  const int finished = checkpoint.load_step;
  const ContinuationOptions& loads = problem.continuation;
  if (finished > 0 && (u.t - loads.from) * (loads.to - loads.from) < 0)
    throw InputError(fmt::format("The checkpoint {} stands at t = {:.6g}, before the first load step of this problem (continuation.from = {:.6g}).",
                                 results.checkpoint_file().string(), u.t, loads.from));
  if (finished > 0 && (u.t - loads.to) * (loads.to - loads.from) >= 0) {
    if (talks && !options.quiet) fmt::print("The run in {} is finished: there is no load step left to resume.\n", results.directory().string());
    return 0;
  }

  const ContinuationStart start{finished, u.t, checkpoint.increment, checkpoint.largest_gradient};
  const int last = last_load_step(loads, start);

  std::unique_ptr<ConsoleTable> table;
  std::string head;  // of the run
  if (talks) {
    head = fmt::format("{}: {} unknowns, {} free, on {} rank{}{}", problem.title, results.summary().unknowns, model.layout->free_dofs(),
                       model.layout->ranks(), model.layout->ranks() == 1 ? "" : "s",
                       finished > 0 ? fmt::format(", resumed after load step {} (t = {:.6g})", finished, u.t) : std::string());
    if (const std::string sentence = reference_sentence(model); !sentence.empty()) head += "\n" + sentence;
    if (!options.quiet) {
      for (const std::string& warning : model.warnings) fmt::print(stderr, "warning: {}\n", warning);
      table = std::make_unique<ConsoleTable>(stdout, last, on_terminal());
      table->line(head);
    }
  }
  if (options.resume)
    results.resume(checkpoint);
  else
    results.begin(u);
  if (talks) report_results(results.directory().string());
  std::unique_ptr<IterationsCsv> iterations;
  std::unique_ptr<RunLog> log;
  together([&] {
    if (!talks) return;
    iterations = std::make_unique<IterationsCsv>(results.directory() / "iterations.csv", options.resume ? finished + 1 : 0);
    log = std::make_unique<RunLog>(results.directory() / "run.log", last, options.resume);
    for (const std::string& warning : model.warnings) log->table().line("warning: " + warning);
    log->table().line(head);
  });

  const auto say = [&](const std::string& sentence) {
    if (table) table->line(sentence);
    if (log) log->table().line(sentence);
  };
  if (!results.replaced().empty()) say(results.replaced());
  results.warn_with([&](const std::string& sentence) { say("warning: " + sentence); });
  std::vector<Observer*> listeners;
  if (table) listeners.push_back(table.get());
  if (log) listeners.push_back(&log->table());
  if (iterations) listeners.push_back(iterations.get());
  listeners.push_back(&results);
  const ContinuationReport report =
      run_continuation(*model.functional, u, boundary_values(model), loads, problem.solver, listeners, start, changing_supports(model));

  results.finish(report.status, outcome(report, finished, last));
  if (!results.page_trouble().empty()) fmt::print(stderr, "warning: there is no page: {} karcher view makes it.\n", results.page_trouble());
  table.reset();
  if (log) log->table().line(final_report(results.summary()));
  if (talks && !options.quiet) {
    fmt::print("{}", final_report(results.summary()));
    fmt::print("  {:<24} {}\n", "results", results.directory().string());
    for (const auto& [file, use] :
         {std::pair("report.html", "opens in a browser"), {"solution.pvd", "opens in ParaView"}, {"summary.json", "numbers"}})
      if (std::filesystem::exists(results.directory() / file)) fmt::print("    {:<22} {}\n", file, use);
  }
  return exit_code(report.status);
}

}  // namespace karcher::app
