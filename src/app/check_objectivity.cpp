#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/check_terms.hpp"
#include "app/term_at_random.hpp"
#include "karcher/manifold/quaternion.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
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
      const RigidMotion rigid = random_motion(space, diagonal(*model.discretisation.mesh), random);
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
