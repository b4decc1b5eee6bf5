#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/launch.hpp"
#include "app/signals.hpp"
#include "app/verbs.hpp"
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

/// The load steps that a checkpoint has left to do.
ContinuationOptions remaining(const ContinuationOptions& all, const Checkpoint& done) {
  ContinuationOptions rest = all;
  rest.from = done.configuration.t;
  if (!all.adaptive) {
    rest.steps = all.steps - done.load_step;
    return rest;
  }
  const double part = (all.to - rest.from) / (all.to - all.from);
  rest.steps = std::max(1, static_cast<int>(std::lround(std::ceil(part * all.steps - 1e-9))));
  rest.smallest = std::min(1.0, all.smallest / part);
  return rest;
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
  Configuration u = model.discretisation.initial;
  rehearse(problem, model);
  const std::uint64_t id = identity(problem, model);

  Checkpoint checkpoint;
  const bool adaptive = problem.continuation.adaptive;
  Results results(problem, model, id, seconds_now(), adaptive ? 0 : problem.continuation.steps);
  if (options.resume) {
    together([&] { checkpoint = read_checkpoint(results.checkpoint_file(), model.fields(), id); });
    u = checkpoint.configuration;
  }
  const int finished = checkpoint.load_step;
  ContinuationOptions continuation = options.resume ? remaining(problem.continuation, checkpoint) : problem.continuation;
  if (options.resume && finished > 0 && (continuation.steps < 1 || u.t == problem.continuation.to)) {
    if (talks && !options.quiet) fmt::print("The run in {} is finished: there is no load step left to resume.\n", results.directory().string());
    return 0;
  }

  std::unique_ptr<ConsoleTable> table;
  if (talks) {
    if (!options.quiet) {
      for (const std::string& warning : model.warnings) fmt::print(stderr, "warning: {}\n", warning);
      table = std::make_unique<ConsoleTable>(stdout, adaptive ? 0 : problem.continuation.steps, on_terminal());
      table->line(fmt::format("{}: {} unknowns, {} free, on {} rank{}{}", problem.title, results.summary().unknowns, model.layout->free_dofs(),
                              model.layout->ranks(), model.layout->ranks() == 1 ? "" : "s",
                              finished > 0 ? fmt::format(", resumed after load step {} (t = {:.6g})", finished, u.t) : std::string()));
    }
  }
  if (options.resume)
    results.resume(checkpoint);
  else
    results.begin(u);
  std::unique_ptr<IterationsCsv> iterations;
  together([&] {
    if (talks) iterations = std::make_unique<IterationsCsv>(results.directory() / "iterations.csv", options.resume ? finished + 1 : 0);
  });

  std::vector<Observer*> listeners;
  if (table) listeners.push_back(table.get());
  if (iterations) listeners.push_back(iterations.get());
  listeners.push_back(&results);
  Renumbered numbered(listeners, finished);
  const std::vector<Observer*> observers{&numbered};
  const ContinuationReport report = run_continuation(*model.functional, u, boundary_values(model), continuation, problem.solver, observers);

  results.finish(report.status, outcome(report, finished, problem.continuation.steps));
  table.reset();
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
