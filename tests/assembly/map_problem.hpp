#pragma once
/// \file
/// One term of one field with random nodal values, through a Functional: the generic path as the solver uses it.

#include <memory>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/testing/random.hpp"

namespace karcher::testing {

/// A generated mesh whose nodes are moved at random by up to `amount` along the axes that its dimension spans (0: not moved).
inline std::shared_ptr<const Mesh> moved_mesh(const std::string& generator, std::map<std::string, std::vector<double>> numbers,
                                              const std::string& shape, double amount = 0, int axes = 0) {
  GeneratorOptions options{generator, std::move(numbers), {}};
  if (!shape.empty()) options.words["shape"] = shape;
  auto mesh = std::make_shared<Mesh>(generate(options));
  karcher::Random random(5);
  for (auto& x : mesh->nodes)
    for (int c = 0; c < axes; ++c) x[c] += random.uniform(-amount, amount);
  return mesh;
}

struct MapProblem {
  TermInput input;
  Configuration u;
  std::shared_ptr<Layout> layout;
  std::unique_ptr<Functional> functional;

  MapProblem(std::shared_ptr<const Mesh> mesh, const ManifoldOps& manifold, Rule rule, int order, const std::string& region = "all") {
    input.mesh = mesh;
    input.region = mesh->region(region);
    input.all_fields = {{"u", &manifold, rule, std::make_shared<Space>(mesh, mesh->region("all"), order)}};
    input.fields = {0};
    u.values.resize(1);
  }
  const Space& space() const { return *input.all_fields.front().space; }
  const ManifoldOps& manifold() const { return *input.all_fields.front().manifold; }

  /// Values retract(centre, v) with random |v_i| < spread, and a centre reached from `origin`.
  void set_random(const std::vector<double>& origin, double spread, std::uint64_t seed = 3) {
    karcher::Random random(seed);
    const auto moved = [&](const std::vector<double>& p, double size) {
      std::vector<double> v, q(p.size());
      for (int k = 0; k < manifold().dim; ++k) v.push_back(random.uniform(-size, size));
      manifold().retract(p.data(), v.data(), q.data());
      return q;
    };
    const std::vector<double> centre = moved(origin, 0.8);
    u.values[0].clear();
    for (int i = 0; i < space().node_count(); ++i)
      for (double x : moved(centre, spread)) u.values[0].push_back(x);
  }
  void make(const std::string& type) {
    const std::vector<std::vector<char>> fixed{std::vector<char>(static_cast<std::size_t>(space().node_count() * manifold().dim))};
    layout = std::make_shared<Layout>(input.all_fields, fixed, CellRanks(input.mesh->cells.size(), 0), 0, 1);
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(make_term(type, input));
    functional = std::make_unique<Functional>(layout, std::move(terms));
  }
  std::size_t dofs() const { return static_cast<std::size_t>(layout->local_dofs()); }
};

/// Energy, gradient and the dense Hessian in the local dofs.
struct Dense {
  Evaluation evaluation;
  std::vector<double> gradient;
  std::vector<std::vector<double>> hessian;

  /// Of a MapProblem or a BodyProblem.
  template <class Problem>
  explicit Dense(const Problem& p) : gradient(p.dofs()), hessian(p.dofs(), std::vector<double>(p.dofs())) {
    BlockMatrix m = p.functional->make_matrix();
    evaluation = p.functional->hessian(p.u, gradient, m);
    const auto bs = static_cast<std::size_t>(m.block_size);
    for (std::size_t i = 0; i + 1 < m.row_begin.size(); ++i)
      for (auto k = static_cast<std::size_t>(m.row_begin[i]); k < static_cast<std::size_t>(m.row_begin[i + 1]); ++k) {
        const auto j = static_cast<std::size_t>(m.column[k]);
        for (std::size_t r = 0; r < bs; ++r)
          for (std::size_t c = 0; c < bs; ++c) {
            const double x = m.values[k * bs * bs + c * bs + r];
            hessian[i * bs + r][j * bs + c] = x;
            if (i != j) hessian[j * bs + c][i * bs + r] = x;
          }
      }
  }
};

}  // namespace karcher::testing
