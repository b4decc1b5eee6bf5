#include "karcher/problem/supports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "karcher/mesh/place_text.hpp"
#include "karcher/mesh/union_find.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/dense.hpp"

namespace karcher {
namespace {

constexpr std::size_t most_sentences = 3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// "x", or "(0.6, 0.8, 0)".
std::string direction_text(Vec3<double> v) {
  v = (1 / std::sqrt(norm2(v))) * v;
  for (int i = 0; i < 3; ++i)
    if (std::abs(v[i]) > 1 - 1e-9) return std::string(1, static_cast<char>('x' + i));
  const auto first = std::ranges::find_if(v.e, [](double c) { return std::abs(c) > 1e-9; });
  if (*first < 0) v = -v;
  return place_text(v, 1);
}

using Motion = std::array<double, 6>;  ///< a, and w times the size of the part

/// A connected part of a body.
struct Part {
  int cells = 0;
  Vec3<double> centre;
  double size = 0;               ///< largest distance of a node from the centre
  std::array<Motion, 6> held{};  ///< sum over the fixed components of r r^T, r the component's rate for every motion
  Motion work{};                 ///< of the loads for every motion
  double largest_work = 0;       ///< sum of their absolute values at the nodes

  void hold(const Motion& r) {
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) held[i][j] += r[i] * r[j];
  }
  /// Rate of the place x in the direction e.
  Motion rate(const Vec3<double>& x, const Vec3<double>& e) const {
    const Vec3<double> turn = cross((1 / size) * (x - centre), e);
    return {e[0], e[1], e[2], turn[0], turn[1], turn[2]};
  }
};

/// An orthonormal basis of the motions that nothing holds.
std::vector<Motion> free_basis(const Part& part) {
  std::vector<double> matrix;
  for (const Motion& row : part.held) matrix.insert(matrix.end(), row.begin(), row.end());
  const Spectrum s = symmetric_eigen(6, std::move(matrix));
  std::vector<Motion> basis;
  for (std::size_t k = 0; k < 6; ++k)
    if (s.values[k] <= 1e-10 * s.values[5]) std::copy_n(s.vectors.begin() + static_cast<std::ptrdiff_t>(6 * k), 6, basis.emplace_back().begin());
  return basis;
}

Vec3<double> translation(const Motion& m) { return {{m[0], m[1], m[2]}}; }
Vec3<double> turn(const Motion& m) { return {{m[3], m[4], m[5]}}; }

/// "move along x and turn about the axis through (0, 0, 0) along y"
std::string motions_text(const Part& part, const std::vector<Motion>& basis) {
  if (basis.size() == 6) return "move and turn freely";
  // The combinations without a turn are translations; what is perpendicular to them turns.
  std::vector<double> turns;
  for (const Motion& a : basis)
    for (const Motion& b : basis) turns.push_back(dot(turn(a), turn(b)));
  const Spectrum s = symmetric_eigen(static_cast<int>(basis.size()), std::move(turns));
  std::vector<Vec3<double>> moves;
  std::vector<Motion> rotations;
  for (std::size_t k = 0; k < basis.size(); ++k) {
    Motion m{};
    for (std::size_t i = 0; i < basis.size(); ++i)
      for (std::size_t j = 0; j < 6; ++j) m[j] += s.vectors[k * basis.size() + i] * basis[i][j];
    if (s.values[k] < 1e-9)
      moves.push_back(translation(m));
    else
      rotations.push_back(m);
  }
  std::vector<std::string> list;
  if (moves.size() == 1) list.push_back("move along " + direction_text(moves[0]));
  if (moves.size() == 2) list.push_back("move in all directions perpendicular to " + direction_text(cross(moves[0], moves[1])));
  if (moves.size() == 3) list.emplace_back("move in all directions");
  // The places at rest under a + w x r lie on the axis through w x a / |w|^2.
  const auto axis_place = [&](const Motion& m) { return part.centre + (part.size / norm2(turn(m))) * cross(turn(m), translation(m)); };
  if (rotations.size() == 3 && moves.empty()) {
    // The point at rest: a_k = -w_k x r for all k, by least squares, 2 r = sum_k w_k x a_k for orthonormal w_k.
    Vec3<double> r;
    for (const Motion& m : rotations) r += (0.5 / norm2(turn(m))) * cross(turn(m), translation(m));
    list.push_back("turn about every axis through " + place_text(part.centre + part.size * r, part.size));
  } else if (rotations.size() == 3) {
    list.emplace_back("turn about every axis");
  } else {
    for (const Motion& m : rotations)
      list.push_back("turn about the axis through " + place_text(axis_place(m), part.size) + " along " + direction_text(turn(m)));
  }
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : " and ") + item;
  return text;
}

/// A deformation with the rotations that go with it in elastic energies, in connected parts.
class Body {
 public:
  Body(const Problem& problem, const DiscreteProblem& model, int field, const Constraints::Fixed& fixed)
      : problem_(problem),
        model_(model),
        field_(field),
        fixed_(fixed),
        places_(reference_positions(problem, space(field))),
        parts_of_nodes_(places_.size(), -1) {
    find_parts();
    hold_fixed(field_, [&](Part& part, int node, std::size_t i) {
      Vec3<double> e;
      e[static_cast<int>(i)] = 1;
      part.hold(part.rate(places_[at(node)], e));
    });
    for (const auto& [rotation, parts] : rotations_) {
      const Field& f = model_.fields()[at(rotation)];
      hold_fixed(rotation, [&](Part& part, int node, std::size_t i) {
        const Vec3<double> axis = axis_of(*f.manifold, model_.discretisation.initial.at(rotation, node, f.manifold->ambient), i);
        part.hold({0, 0, 0, axis[0], axis[1], axis[2]});
      });
    }
  }

  /// Work of the loads of this rank's cells. The load parameter must be set.
  void add_loads() {
    for (std::size_t t = 0; t < problem_.terms.size(); ++t) {
      const TermSpec& spec = problem_.terms[t];
      if (!spec.info.load || std::find(spec.fields.begin(), spec.fields.end(), field_) == spec.fields.end()) continue;
      const Term& term = *model_.functional->terms()[t];
      BatchResult result;
      for (int b = 0; b < term.batch_count(); ++b) {
        const Batch& batch = term.batch(b);
        std::size_t unknowns = 0;
        for (const LocalBlock& block : *batch.blocks) unknowns += at(block.dim);
        result.gradient.resize(unknowns * native_width);
        term.evaluate(model_.discretisation.initial, b, Want::gradient, result);
        std::size_t first = 0;
        for (std::size_t k = 0; k < batch.blocks->size(); first += at((*batch.blocks)[k++].dim)) {
          if ((*batch.blocks)[k].field != field_) continue;
          for (std::size_t lane = 0; lane < at(batch.cells_used); ++lane) {
            Vec3<double> force;
            for (int i = 0; i < (*batch.blocks)[k].dim; ++i) force[i] = -result.gradient[(first + at(i)) * native_width + lane];
            add_force(batch.nodes[k * native_width + lane], force);
          }
        }
      }
    }
  }

  std::vector<Part>& parts() { return parts_; }

 private:
  /// Whether points turn with the body: rotations and directors.
  static bool turns(const ManifoldOps& m) { return (m.body_axes && m.arrays.size() == 3) || m.directions; }
  /// The axis of which the i-th tangent coordinate at a point measures the turn w: d_i . w with the body's axis d_i; for a director d, e_i . (w x d) = (d x e_i) . w.
  static Vec3<double> axis_of(const ManifoldOps& m, const double* point, std::size_t i) {
    std::array<double, 3> d{};
    if (!m.directions) {
      m.arrays[i].value(point, d.data());
      return {d};
    }
    std::array<double, 6> e{};
    m.frame(point, e.data());
    return cross(Vec3<double>{{point[0], point[1], point[2]}}, Vec3<double>{{e[i], e[2 + i], e[4 + i]}});
  }
  const Space& space(int field) const { return *model_.fields()[at(field)].space; }

  void find_parts() {
    UnionFind sets(at(space(field_).node_count()));
    const auto for_cells = [&](auto visit) {
      for (const TermSpec& term : problem_.terms)
        if (term.info.stress_free && std::find(term.fields.begin(), term.fields.end(), field_) != term.fields.end())
          for (const Cell& c : model_.discretisation.mesh->region(term.on).cells) visit(term, c, space(field_).entity_nodes(c));
    };
    for_cells([&](const TermSpec&, const Cell&, const std::vector<int>& nodes) {
      for (const int n : nodes) sets.join(nodes[0], n);
    });
    std::map<int, int> numbers;
    for_cells([&](const TermSpec& term, const Cell& c, const std::vector<int>& nodes) {
      const int part = numbers.emplace(sets.root(nodes[0]), static_cast<int>(numbers.size())).first->second;
      parts_.resize(numbers.size());
      ++parts_[at(part)].cells;
      for (const int n : nodes) parts_of_nodes_[at(n)] = part;
      for (const int f : term.fields) {
        const Field& field = model_.fields()[at(f)];
        if (!turns(*field.manifold)) continue;
        std::vector<int>& parts = rotations_[f];
        parts.resize(at(field.space->node_count()), -1);
        for (const int n : field.space->entity_nodes(c)) parts[at(n)] = part;
      }
    });
    std::vector<double> counts(parts_.size(), 0.0);
    for (std::size_t n = 0; n < places_.size(); ++n)
      if (const int p = parts_of_nodes_[n]; p >= 0) {
        parts_[at(p)].centre += places_[n];
        ++counts[at(p)];
      }
    for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p].centre = (1 / counts[p]) * parts_[p].centre;
    for (std::size_t n = 0; n < places_.size(); ++n)
      if (const int p = parts_of_nodes_[n]; p >= 0)
        parts_[at(p)].size = std::max(parts_[at(p)].size, std::sqrt(norm2(places_[n] - parts_[at(p)].centre)));
    if (model_.fields()[at(field_)].manifold->dim == 2)  // nothing leaves the plane
      for (Part& part : parts_)
        for (const std::size_t motion : {2U, 3U, 4U}) {
          Motion held{};
          held[motion] = 1;
          part.hold(held);
        }
  }

  template <class Hold>
  void hold_fixed(int field, Hold hold) {
    const std::vector<char>& fixed = fixed_[at(field)];
    const std::vector<int>& parts = field == field_ ? parts_of_nodes_ : rotations_.at(field);
    const auto dim = at(model_.fields()[at(field)].manifold->dim);
    for (std::size_t k = 0; k < fixed.size(); ++k)
      if (const int part = parts[k / dim]; fixed[k] && part >= 0) hold(parts_[at(part)], static_cast<int>(k / dim), k % dim);
  }

  void add_force(int node, const Vec3<double>& force) {
    const int p = parts_of_nodes_[at(node)];
    if (p < 0) return;
    Part& part = parts_[at(p)];
    const Motion rate = part.rate(places_[at(node)], force);
    for (std::size_t j = 0; j < 6; ++j) {
      part.work[j] += rate[j];
      part.largest_work += std::abs(rate[j]);
    }
  }

  const Problem& problem_;
  const DiscreteProblem& model_;
  int field_;
  const Constraints::Fixed& fixed_;
  std::vector<Vec3<double>> places_;
  std::vector<int> parts_of_nodes_;
  std::map<int, std::vector<int>> rotations_;  ///< field -> part of every node, or -1
  std::vector<Part> parts_;
};

/// Deformations of elastic energies that no other energy holds.
std::vector<int> deformations(const Problem& problem, const DiscreteProblem& model) {
  std::vector<int> list;
  for (const TermSpec& term : problem.terms)
    for (std::size_t k = 0; k < term.fields.size(); ++k) {
      const int f = term.fields[k];
      const ManifoldOps& m = *model.fields()[at(f)].manifold;
      const bool held = std::ranges::any_of(problem.terms, [&](const TermSpec& other) {
        return !other.info.load && !other.info.stress_free && std::find(other.fields.begin(), other.fields.end(), f) != other.fields.end();
      });
      const bool known = std::find(list.begin(), list.end(), f) != list.end();
      if (term.info.stress_free && term.info.fields[k].moves && m.linear && m.dim >= 2 && !held && !known) list.push_back(f);
    }
  return list;
}

}  // namespace

std::vector<std::string> free_motions(const Problem& problem, const DiscreteProblem& model) {
  std::vector<std::string> sentences;
  const auto& phases = model.discretisation.constraints.phases();
  for (const int f : deformations(problem, model))
    for (const Constraints::Phase& phase : phases) {
      Body body(problem, model, f, phase.fixed);
      model.functional->set_load_parameter(phase.end);
      body.add_loads();
      model.functional->set_load_parameter(problem.continuation.from);
      const FieldSpec& field = problem.fields[at(f)];
      const std::string place = field.place.text().empty() ? "" : field.place.text() + ": ";
      const std::string when = phases.size() > 1 ? fmt::format("where {:.6g} < t <= {:.6g}, ", phase.begin, phase.end) : "";
      std::size_t found = 0;
      for (Part& part : body.parts()) {
        sum_over_ranks(part.work);
        part.largest_work = sum_over_ranks(part.largest_work);
        const std::vector<Motion> basis = free_basis(part);
        if (basis.empty() || ++found > most_sentences) continue;
        bool pushed = false;
        for (const Motion& m : basis)
          pushed = pushed || std::abs(std::inner_product(m.begin(), m.end(), part.work.begin(), 0.0)) > 1e-9 * part.largest_work;
        const std::string what = body.parts().size() == 1
                                     ? "the body"
                                     : fmt::format("the part of {} around {}", cells_text(part.cells), place_text(part.centre, part.size));
        sentences.push_back(fmt::format("{}{}nothing holds the field \"{}\" completely: {} can {}{}.", place, when, field.name, what,
                                        motions_text(part, basis),
                                        pushed ? fmt::format(", and the loads at t = {:.6g} push it that way", phase.end) : std::string()));
      }
      if (found > most_sentences) sentences.push_back(fmt::format("{}{}so can {} further parts.", place, when, found - most_sentences));
    }
  return sentences;
}

}  // namespace karcher
