#include "karcher/problem/solution.hpp"

#include "karcher/io/iterations.hpp"
#include "karcher/problem/results.hpp"
#include "karcher/solve/exchange.hpp"
#include "karcher/solve/together.hpp"

namespace karcher {
namespace {

class Recorder : public Observer {
 public:
  Recorder(const Layout& layout, std::vector<Configuration>& states, std::vector<IterationRecord>& iterations)
      : layout_(layout), states_(states), iterations_(iterations) {}
  void iteration(const IterationRecord& record) override { iterations_.push_back(record); }
  void load_step_finished(const StepReport&, const Configuration& u) override {
    states_.push_back(u);
    complete(layout_, states_.back());
  }

 private:
  const Layout& layout_;
  std::vector<Configuration>& states_;
  std::vector<IterationRecord>& iterations_;
};

}  // namespace

Solution solve(const Problem& problem, std::span<Observer* const> observers) {
  Solution s;
  s.problem_ = std::make_shared<const Problem>(problem);
  std::shared_ptr<const Mesh> mesh;
  together([&] {
    check_solvable(problem);
    mesh = build_mesh(problem);
  });
  s.model_ = std::make_shared<DiscreteProblem>(build(problem, mesh));
  rehearse(problem, *s.model_);
  Configuration u = s.model_->discretisation.start;
  s.states_.push_back(u);
  Recorder recorder(*s.model_->layout, s.states_, s.iterations_);
  std::vector<Observer*> all(observers.begin(), observers.end());
  all.push_back(&recorder);
  s.report_ = run_continuation(*s.model_->functional, u, boundary_values(*s.model_), problem.continuation, problem.solver, all, {},
                               changing_supports(*s.model_));
  return s;
}

Solution solve(Problem problem, const ContinuationOptions& continuation, const SolverOptions& solver) {
  problem.continuation = continuation;
  problem.solver = solver;
  return solve(problem);
}

std::vector<double> Solution::value_at(int field, const Vec3<double>& x) const {
  ProbeSpec probe;
  probe.field = field;
  probe.at = x;
  return probe_value(probe, *problem_, *model_, states_.back());
}

void Solution::save(const std::filesystem::path& directory) const {
  Problem problem = *problem_;
  problem.output.directory = std::filesystem::absolute(directory).lexically_normal();
  Results results(problem, *model_, identity(problem, *model_), 0);
  model_->functional->set_load_parameter(states_.front().t);
  results.begin(states_.front());
  std::unique_ptr<IterationsCsv> csv;
  together([&] {
    if (model_->layout->rank() == 0) csv = std::make_unique<IterationsCsv>(problem.output.directory / "iterations.csv");
  });
  std::vector<Observer*> writers{&results};
  if (csv) writers.push_back(csv.get());
  for (const IterationRecord& r : iterations_)
    if (csv) csv->iteration(r);
  for (std::size_t k = 0; k < report_.steps.size(); ++k) {
    model_->functional->set_load_parameter(states_[k + 1].t);
    for (Observer* o : writers) o->load_step_finished(report_.steps[k], states_[k + 1]);
  }
  results.finish(report_.status, report_.steps.empty() ? "No load step was made." : report_.steps.back().reason);
}

}  // namespace karcher
