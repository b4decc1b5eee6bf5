#include "app/check_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "karcher/manifold/quaternion.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Mean edge length of the cells: steps of positions are measured in it.
double cell_size(const Mesh& mesh) {
  double sum = 0;
  for (const Cell& c : mesh.cells) {
    const Vec3<double> a = mesh.nodes[static_cast<std::size_t>(c.nodes[0])], b = mesh.nodes[static_cast<std::size_t>(c.nodes[1])];
    sum += std::sqrt(norm2(b - a));
  }
  return sum / static_cast<double>(mesh.cells.size());
}

/// Tangent coordinates of all nodes of all fields, those that are fixed, too.
using Step = std::vector<std::vector<double>>;

/// Positions move by parts of a cell, other fields by parts of a radian.
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

/// A term at a configuration; with the derivatives along a step, where one is given.
struct Along {
  double energy = 0, first = 0, second = 0;
  double size = 0, first_size = 0, second_size = 0;  ///< sums of absolute values
  bool defined = true;
};

Along evaluate(const Term& term, const Configuration& u, const Step* step = nullptr) {
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

/// Largest relative errors of first and second derivative against central differences of the fourth order, with the best of some steps.
struct Errors {
  double gradient = std::numeric_limits<double>::infinity(), hessian = std::numeric_limits<double>::infinity();
  bool right = false, measured = false;
};

Errors errors(const DiscreteProblem& model, const Term& term, const Configuration& u, const Step& step) {
  const Along at = evaluate(term, u, &step);
  Errors e;
  if (!at.defined) return e;
  const auto over = [&](double size) { return size > 0 ? size : at.size > 0 ? at.size : 1.0; };
  double noise = 0;
  for (double h = 0.5; h > 1e-4; h /= 2) {
    std::array<double, 4> f{};
    bool defined = true;
    for (std::size_t k = 0; k < 4 && defined; ++k) {
      constexpr std::array<double, 4> times{-2, -1, 1, 2};
      const Along there = evaluate(term, moved(model, u, step, times[k] * h));
      f[k] = there.energy;
      noise = std::max({noise, epsilon * there.size, epsilon * at.size});
      defined = there.defined;
    }
    if (!defined) continue;
    e.measured = true;
    const double first = (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * h);
    const double second = (16 * (f[2] + f[1]) - (f[3] + f[0]) - 30 * at.energy) / (12 * h * h);
    e.gradient = std::min(e.gradient, std::abs(first - at.first) / over(at.first_size));
    e.hessian = std::min(e.hessian, std::abs(second - at.second) / over(at.second_size));
  }
  e.right = e.measured && e.gradient < 1e-7 + 1e3 * noise / over(at.first_size) && e.hessian < 1e-5 + 1e4 * noise / over(at.second_size);
  return e;
}

/// Initial values with random ones near them, at which all terms are defined; further away first.
Configuration near_the_start(const DiscreteProblem& model, std::mt19937& random) {
  const Configuration& start = model.discretisation.start;
  for (const double size : {0.02, 0.002, 0.0002}) {
    const Configuration u = moved(model, start, random_step(model, size, random), 1);
    if (!model.functional->energy(u).failure) return u;
  }
  return start;
}

/// "a, b and c"
std::string listed(const std::vector<std::string>& names) {
  std::string s;
  for (std::size_t i = 0; i < names.size(); ++i) s += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return s;
}

}  // namespace

bool check_derivatives(const DiscreteProblem& model) {
  std::mt19937 random(20240611);
  const Configuration u = near_the_start(model, random);
  const Step step = random_step(model, 0.05, random);
  fmt::print("\nderivatives: relative errors against differences of the energy, at random values near the initial ones\n");
  fmt::print("  {:<24} {:>12} {:>12}\n", "", "gradient", "Hessian");
  std::vector<std::string> wrong, unknown;
  for (std::size_t k = 0; k < model.term_names.size(); ++k) {
    const Errors e = errors(model, *model.functional->terms()[k], u, step);
    if (!e.measured)
      fmt::print("  {:<24} {:>12} {:>12}\n", model.term_names[k], "not defined", "");
    else
      fmt::print("  {:<24} {:>12.2e} {:>12.2e}{}\n", model.term_names[k], e.gradient, e.hessian, e.right ? "" : "  wrong");
    if (!e.right) (e.measured ? wrong : unknown).push_back(model.term_names[k]);
  }
  if (!unknown.empty()) fmt::print("the derivatives of {} cannot be checked: there is no energy near the initial values\n", listed(unknown));
  if (!wrong.empty()) fmt::print("gradient or Hessian of {} is wrong\n", listed(wrong));
  if (unknown.empty() && wrong.empty()) fmt::print("gradient and Hessian are right\n");
  return unknown.empty() && wrong.empty();
}

namespace {

/// What a rigid motion does with the values of a field.
enum class Role { none, position, rotation, direction };

std::vector<Role> roles(const Problem& problem) {
  std::vector<Role> all;
  for (const FieldSpec& f : problem.fields)
    all.push_back(f.manifold->body_axes ? Role::rotation : f.manifold->directions ? Role::direction : Role::none);
  for (const TermSpec& t : problem.terms)
    for (std::size_t k = 0; k < t.fields.size(); ++k)
      if (t.info.fields[k].moves) all[static_cast<std::size_t>(t.fields[k])] = Role::position;
  return all;
}

/// R x + c of positions, R Q of rotations, R d of directions; of positions in the plane or on a line their part of x.
struct RigidMotion {
  Quaternion<double> q;
  Vec3<double> translation;

  void apply(Role role, int ambient, double* x) const {
    if (role == Role::rotation) {
      const Quaternion<double> turned = quaternion_product(q, Quaternion<double>{{x[0], x[1], x[2], x[3]}});
      std::copy(turned.e.begin(), turned.e.end(), x);
      return;
    }
    Vec3<double> v;
    for (int i = 0; i < ambient; ++i) v[i] = x[i];
    v = rotation_matrix(q) * v;
    if (role == Role::position) v += translation;
    for (int i = 0; i < ambient; ++i) x[i] = v[i];
  }
};

RigidMotion random_motion(int space, double size, std::mt19937& random) {
  std::normal_distribution<double> normal;
  RigidMotion m{{{1}}, {}};
  for (int i = 0; i < space; ++i) m.translation[i] = size * normal(random);
  if (space == 2) m.q = quaternion_of_rotation_vector(Vec3<double>{{0, 0, normal(random)}});
  if (space < 3) return m;
  for (double& x : m.q.e) x = normal(random);
  m.q = (1 / std::sqrt(norm2(m.q))) * m.q;
  return m;
}

double extent(const Mesh& mesh) {
  Vec3<double> low = mesh.nodes.front(), high = low;
  for (const Vec3<double>& x : mesh.nodes)
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], x[i]);
      high[i] = std::max(high[i], x[i]);
    }
  return std::sqrt(norm2(high - low));
}

/// Why rigid motions say nothing about a term; empty if they do.
std::string reason_not_to(const TermSpec& term, const std::vector<Role>& role, const Problem& problem) {
  if (term.info.load) return "a load";
  bool body = false;
  for (const int f : term.fields) {
    const Role r = role[static_cast<std::size_t>(f)];
    const FieldSpec& field = problem.fields[static_cast<std::size_t>(f)];
    if (r == Role::none)
      return fmt::format("\"{}\" holds neither positions nor rotations{}", field.name,
                         term.info.formula && field.manifold->linear ? fmt::format("; moves = \"{}\" says that it does", field.name) : std::string());
    body = body || r == Role::position || r == Role::rotation;
  }
  return body ? "" : "without positions and rotations";
}

}  // namespace

bool check_objectivity(const Problem& problem, const DiscreteProblem& model) {
  std::mt19937 random(20240611);
  const Configuration u = near_the_start(model, random);
  const std::vector<Role> role = roles(problem);
  int space = 3;
  for (std::size_t f = 0; f < role.size(); ++f)
    if (role[f] == Role::position) space = std::min(space, problem.fields[f].manifold->ambient);
  fmt::print("\nobjectivity: relative change of the energy by rigid motions, at random values near the initial ones\n");
  std::vector<std::string> wrong;
  for (std::size_t k = 0; k < problem.terms.size(); ++k) {
    const std::string& name = model.term_names[k];
    if (const std::string reason = reason_not_to(problem.terms[k], role, problem); !reason.empty()) {
      fmt::print("  {:<24} not tested: {}\n", name, reason);
      continue;
    }
    const Term& term = *model.functional->terms()[k];
    const Along before = evaluate(term, u);
    double change = 0;
    for (int motion = 0; motion < 5; ++motion) {
      const RigidMotion rigid = random_motion(space, extent(*model.discretisation.mesh), random);
      Configuration after = u;
      for (const int f : problem.terms[k].fields) {
        const Field& field = model.fields()[static_cast<std::size_t>(f)];
        for (int node = 0; node < field.space->node_count(); ++node)
          rigid.apply(role[static_cast<std::size_t>(f)], field.manifold->ambient, after.at(f, node, field.manifold->ambient));
      }
      const Along there = evaluate(term, after);
      const double difference = there.defined && before.defined ? std::abs(there.energy - before.energy) / std::max(before.size, 1e-300)
                                                                : std::numeric_limits<double>::infinity();
      change = std::max(change, difference);
    }
    const bool same = change < 1e-8;
    fmt::print("  {:<24} {:>12.2e}{}\n", name, change, same ? "" : "  changes");
    if (!same) wrong.push_back(name);
  }
  fmt::print("{}\n", wrong.empty() ? "no energy changes" : "a rigid motion changes " + listed(wrong));
  return wrong.empty();
}

}  // namespace karcher::app
