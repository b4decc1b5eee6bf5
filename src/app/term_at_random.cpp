#include "app/term_at_random.hpp"

#include <cmath>

namespace karcher::app {
namespace {

/// Mean edge length of the cells: steps of positions are measured in it.
double cell_size(const Mesh& mesh) {
  double sum = 0;
  for (const Cell& c : mesh.cells) {
    const Vec3<double> a = mesh.nodes[static_cast<std::size_t>(c.nodes[0])], b = mesh.nodes[static_cast<std::size_t>(c.nodes[1])];
    sum += std::sqrt(norm2(b - a));
  }
  return sum / static_cast<double>(mesh.cells.size());
}

}  // namespace

Step random_step(const DiscreteProblem& model, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double length = cell_size(*model.discretisation.mesh);
  Step step;
  for (const Field& field : model.fields()) {
    auto& mine = step.emplace_back();
    for (int node = 0; node < field.space->node_count(); ++node)
      for (const bool is_length : field.manifold->lengths) mine.push_back(size * (is_length ? length : 1.0) * uniform(random));
  }
  return step;
}

Configuration moved(const DiscreteProblem& model, const Configuration& from, const Step& step, double factor) {
  Configuration u = from;
  std::vector<double> v;
  for (std::size_t f = 0; f < step.size(); ++f) {
    const Field& field = model.fields()[f];
    const auto dim = static_cast<std::size_t>(field.manifold->dim);
    v.resize(dim);
    for (int node = 0; node < field.space->node_count(); ++node) {
      for (std::size_t i = 0; i < dim; ++i) v[i] = factor * step[f][static_cast<std::size_t>(node) * dim + i];
      double* x = u.at(static_cast<int>(f), node, field.manifold->ambient);
      field.manifold->retract(x, v.data(), x);
    }
  }
  return u;
}

Along evaluate(const Term& term, const Configuration& u, const Step* step) {
  constexpr auto width = static_cast<std::size_t>(native_width);
  Along sum;
  BatchResult out;
  std::vector<double> v;
  for (int b = 0; b < term.batch_count() && sum.defined; ++b) {
    const Batch& batch = term.batch(b);
    std::size_t n = 0;
    for (const LocalBlock& block : *batch.blocks) n += static_cast<std::size_t>(block.dim);
    if (step) out.gradient.assign(n * width, 0.0);
    if (step) out.hessian.assign(n * n * width, 0.0);
    out.trouble.fill(Trouble::none);
    term.evaluate(u, b, step ? Want::hessian : Want::energy, out);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch.cells_used); ++lane) {
      if (out.trouble[lane] != Trouble::none || !std::isfinite(out.energy[lane])) sum.defined = false;
      sum.energy += out.energy[lane];
      sum.size += std::abs(out.energy[lane]);
      if (!step) continue;
      v.clear();
      for (std::size_t k = 0; k < batch.blocks->size(); ++k) {
        const LocalBlock& block = (*batch.blocks)[k];
        const auto first = static_cast<std::size_t>(batch.nodes[k * width + lane] * block.dim);
        const auto& mine = (*step)[static_cast<std::size_t>(block.field)];
        v.insert(v.end(), mine.begin() + static_cast<std::ptrdiff_t>(first), mine.begin() + static_cast<std::ptrdiff_t>(first) + block.dim);
      }
      for (std::size_t r = 0; r < n; ++r) {
        const double slope = out.gradient[r * width + lane] * v[r];
        sum.first += slope;
        sum.first_size += std::abs(slope);
        for (std::size_t c = r; c < n; ++c) {  // the upper triangle is there
          const double bend = (r == c ? 1 : 2) * v[r] * out.hessian[(r * n + c) * width + lane] * v[c];
          sum.second += bend;
          sum.second_size += std::abs(bend);
        }
      }
    }
  }
  if (!std::isfinite(sum.first) || !std::isfinite(sum.second)) sum.defined = false;
  return sum;
}

Configuration near_the_start(const DiscreteProblem& model, std::mt19937& random) {
  const Configuration& start = model.discretisation.start;
  for (const double size : {0.02, 0.002, 0.0002}) {
    const Configuration u = moved(model, start, random_step(model, size, random), 1);
    if (!model.functional->energy(u).failure) return u;
  }
  return start;
}

}  // namespace karcher::app
