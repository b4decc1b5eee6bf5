#include "karcher/problem/free_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "karcher/mesh/place_text.hpp"

namespace karcher {

std::vector<signed char> free_axes(const TermSpec& term, const Discretisation& d) {
  const auto number = static_cast<std::size_t>(term.fields.front());
  const Field& field = d.fields[number];
  const auto dim = static_cast<std::size_t>(field.manifold->dim);
  std::vector<signed char> axes(static_cast<std::size_t>(field.space->node_count()), -1);
  for (const Cell& cell : d.mesh->region(term.on).cells)
    for (const int node : field.space->entity_nodes(cell)) {
      std::optional<int> known;  // of an earlier phase
      for (const Constraints::Phase& phase : d.constraints.phases()) {
        const auto held = phase.fixed[number].begin() + node * static_cast<std::ptrdiff_t>(dim);
        const auto free = std::find(held, held + static_cast<std::ptrdiff_t>(dim), 0) - held;
        const int axis = free == static_cast<std::ptrdiff_t>(dim) ? -1 : static_cast<int>(free);
        const bool several = std::count(held, held + static_cast<std::ptrdiff_t>(dim), 0) > 1;
        if (several || known.value_or(axis) != axis)
          refuse(
              term.place,
              fmt::format(
                  "{}: a moment has a potential only where the rotation turns about one axis, the same in all load steps; \"{}\" can turn about {} "
                  "at {}. Leave one axis free there (under [[dirichlet]], value = {{axis-free = \"e3\"}}), or prescribe the rotation instead of "
                  "the moment.",
                  term.path, field.name, several ? "several" : "others", place_text(field.space->position(node), diagonal(*d.mesh))));
        known = axis;
      }
      axes[static_cast<std::size_t>(node)] = static_cast<signed char>(*known);
    }
  return axes;
}

}  // namespace karcher
