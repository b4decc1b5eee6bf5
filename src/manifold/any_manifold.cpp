#include "karcher/manifold/any_manifold.hpp"

#include <fmt/format.h>

#include <utility>

#include "karcher/error.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/manifold/unitary.hpp"
#include "karcher/text.hpp"

namespace karcher {

namespace {

struct Entry {
  const ManifoldOps* ops;
  std::string description;
};

const std::vector<Entry>& table() {
  static const std::vector<Entry> entries{
      {&manifold_ops<Euclidean<1>>(), "the real line"},
      {&manifold_ops<Euclidean<2>>(), "the Euclidean plane"},
      {&manifold_ops<Euclidean<3>>(), "Euclidean space"},
      {&manifold_ops<Sphere<1>>(), "the unit circle; points are unit vectors of R^2"},
      {&manifold_ops<Sphere<2>>(), "the unit sphere; points are unit vectors of R^3"},
      {&manifold_ops<Sphere<3>>(), "the unit sphere of R^4"},
      {&manifold_ops<Rotation>(), "rotations of space; points are unit quaternions (w, x, y, z), q and -q the same; distance = angle of rotation"},
      {&manifold_ops<Unitary>(), "special unitary group as unit quaternions (w, x, y, z), q and -q different; metric of the unit sphere of R^4"},
      {&manifold_ops<Spd<2>>(), "symmetric positive definite 2x2 matrices (4 entries by rows), affine-invariant metric"},
      {&manifold_ops<Spd<3>>(), "symmetric positive definite 3x3 matrices (9 entries by rows), affine-invariant metric"},
      {&manifold_ops<Hyperbolic<2>>(), "hyperbolic plane, hyperboloid x0^2 = 1 + x1^2 + x2^2, x0 > 0"},
      {&manifold_ops<Hyperbolic<3>>(), "hyperbolic space, hyperboloid x0^2 = 1 + x1^2 + x2^2 + x3^2, x0 > 0"},
  };
  return entries;
}

const Entry& find(const std::string& name) {
  for (const Entry& e : table())
    if (e.ops->name == name) return e;
  const std::vector<std::string> names = manifold_names();
  throw InputError(fmt::format("There is no manifold \"{}\". {}", name, suggestion(name, names, "Known manifolds")));
}

}  // namespace

const ManifoldOps& manifold_by_name(const std::string& name) { return *find(name).ops; }

const std::string& manifold_description(const std::string& name) { return find(name).description; }

std::vector<std::string> manifold_names() {
  std::vector<std::string> names;
  for (const Entry& e : table()) names.push_back(e.ops->name);
  return names;
}

}  // namespace karcher
