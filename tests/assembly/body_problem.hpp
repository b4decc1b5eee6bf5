#pragma once
/// \file
/// One term of a deformation and of rotations or directors, through a Functional.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "assembly/map_problem.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/testing/objectivity_checks.hpp"

namespace karcher::testing {

struct BodyProblem {
  TermInput input;
  Configuration u;  ///< fields: deformation, then the other
  std::shared_ptr<Layout> layout;
  std::unique_ptr<Functional> functional;

  /// Deformation = position of the nodes, the other field at its standard point.
  BodyProblem(std::shared_ptr<const Mesh> mesh, const ManifoldOps& other, Rule rule, int order, int other_order = 0) {
    input.mesh = mesh;
    input.region = mesh->region("all");
    input.all_fields = {{"m", &manifold_ops<Euclidean<3>>(), rule, std::make_shared<Space>(mesh, input.region, order)},
                        {"q", &other, rule, std::make_shared<Space>(mesh, input.region, other_order == 0 ? order : other_order)}};
    input.fields = {0, 1};
    u = input.start();
    set_deformation([](const Vec3<double>& x) { return x; });
  }
  const Field& field(std::size_t f) const { return input.all_fields[f]; }
  std::size_t dofs() const { return static_cast<std::size_t>(layout->local_dofs()); }

  template <class F>
  void set(std::size_t f, F value) {
    u.values[f].clear();
    for (int i = 0; i < field(f).space->node_count(); ++i)
      for (const double x : value(field(f).space->position(i)).e) u.values[f].push_back(x);
  }
  template <class F>
  void set_deformation(F position) {
    set(0, position);
  }
  template <class F>
  void set_other(F point) {
    set(1, point);
  }
  /// Makes the other field's values the initial ones of the term.
  void start_here() { input.initial = std::make_shared<const Configuration>(u); }
  /// Moves every node of both fields at random, by tangent coordinates up to these sizes.
  void perturb(double deformation, double other, std::uint64_t seed = 3) {
    karcher::Random random(seed);
    for (std::size_t f = 0; f < 2; ++f)
      for (int i = 0; i < field(f).space->node_count(); ++i) {
        const ManifoldOps& m = *field(f).manifold;
        std::vector<double> v, moved(static_cast<std::size_t>(m.ambient));
        for (int k = 0; k < m.dim; ++k) v.push_back((f == 0 ? deformation : other) * random.uniform(-1, 1));
        double* x = u.at(static_cast<int>(f), i, m.ambient);
        m.retract(x, v.data(), moved.data());
        std::copy(moved.begin(), moved.end(), x);
      }
  }
  void make(std::unique_ptr<Term> term) {
    std::vector<std::vector<char>> fixed;
    for (const Field& f : input.all_fields) fixed.emplace_back(static_cast<std::size_t>(f.space->node_count() * f.manifold->dim));
    layout = std::make_shared<Layout>(input.all_fields, fixed, CellRanks(input.mesh->cells.size(), 0), 0, 1);
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(std::move(term));
    functional = std::make_unique<Functional>(layout, std::move(terms));
  }
  void make(const std::string& type) { make(make_term(type, input)); }
  const Term& term() const { return *functional->terms().front(); }
  double energy() const { return functional->energy(u).energy; }
  double largest_force() const {
    std::vector<double> g(dofs());
    functional->gradient(u, g);
    double largest = 0;
    for (const double x : g) largest = std::max(largest, std::fabs(x));
    return largest;
  }
};

/// largest_change_by_rigid_motions of the energy of a deformation and a rotation at p.u.
inline double change_by_rigid_motions(const BodyProblem& p) {
  std::vector<Vec3<double>> positions;
  std::vector<Quaternion<double>> rotations;
  for (int i = 0; i < p.field(0).space->node_count(); ++i) positions.push_back(manifold_detail::read<3>(p.u.at(0, i, 3)));
  for (int i = 0; i < p.field(1).space->node_count(); ++i) rotations.push_back(manifold_detail::read<4>(p.u.at(1, i, 4)));
  const auto energy = [&](const std::vector<Vec3<double>>& m, const std::vector<Quaternion<double>>& q) {
    Configuration moved = p.u;
    for (std::size_t i = 0; i < m.size(); ++i) std::copy(m[i].e.begin(), m[i].e.end(), moved.at(0, static_cast<int>(i), 3));
    for (std::size_t i = 0; i < q.size(); ++i) std::copy(q[i].e.begin(), q[i].e.end(), moved.at(1, static_cast<int>(i), 4));
    return p.functional->energy(moved).energy;
  };
  return largest_change_by_rigid_motions(energy, positions, rotations);
}

/// Largest differences of energy, gradient and Hessian, each relative to the largest entry.
inline double largest_difference(const Dense& a, const Dense& b) {
  double gradient = 0, hessian = 0, gradient_size = 0, hessian_size = 0;
  for (std::size_t r = 0; r < a.gradient.size(); ++r) {
    gradient = std::max(gradient, std::fabs(a.gradient[r] - b.gradient[r]));
    gradient_size = std::max(gradient_size, std::fabs(b.gradient[r]));
    for (std::size_t c = 0; c < a.gradient.size(); ++c) {
      hessian = std::max(hessian, std::fabs(a.hessian[r][c] - b.hessian[r][c]));
      hessian_size = std::max(hessian_size, std::fabs(b.hessian[r][c]));
    }
  }
  const double energy = std::fabs(a.evaluation.energy / b.evaluation.energy - 1);
  return std::max({energy, gradient / gradient_size, hessian / hessian_size});
}

}  // namespace karcher::testing
