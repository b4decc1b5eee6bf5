#include "karcher/manifold/any_manifold.hpp"

#include <fmt/format.h>

#include "karcher/error.hpp"
#include "karcher/manifold/every_manifold.hpp"
#include "karcher/text.hpp"

namespace karcher {

const ManifoldOps& manifold_by_name(const std::string& name) {
  const ManifoldOps* found = nullptr;
  EveryManifold::for_each([&]<class M>() {
    if (M::name == name) found = &manifold_ops<M>();
  });
  if (!found) throw InputError(fmt::format("There is no manifold \"{}\". {}", name, suggestion(name, manifold_names(), "Known manifolds")));
  return *found;
}

std::vector<std::string> manifold_names() { return EveryManifold::names(); }

}  // namespace karcher
