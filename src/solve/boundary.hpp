#pragma once
/// \file
/// Moving the fixed components of a configuration to prescribed values. Vectors have local dofs.

#include <span>
#include <string>
#include <vector>

#include "karcher/field/layout.hpp"

namespace karcher {

/// Tangent coordinates of the way from u to the fixed components of `boundary`; free components 0.
std::vector<double> boundary_increment(const Layout& layout, const Configuration& u, const Configuration& boundary);

/// A sentence where boundary data turn by more than 90 degrees from u, with the field and the place; else empty. Collective.
std::string far_turn(const Layout& layout, const Configuration& u, const Configuration& boundary);

/// Norm (of solve/norm.hpp) of the step that moves all nodes as far as s moves the farthest one of each field. Collective.
double uniform_norm(const Layout& layout, std::span<const double> mass, std::span<const double> s);

/// As Layout::retract, but fixed components move, too. Nodes that are wholly fixed get the value of `boundary` itself, not what rounding has made of it.
void retract_to_boundary(const Layout& layout, const Configuration& from, std::span<const double> step, const Configuration& boundary,
                         Configuration& to);

/// The values of `boundary` at nodes that are wholly fixed.
void copy_fixed_nodes(const Layout& layout, const Configuration& boundary, Configuration& u);

}  // namespace karcher
