#pragma once
/// \file
/// Spread: how far the values of a field lie apart within a cell. An interpolation of values that turn by more than 90 degrees says little about the map that is
/// meant, and between opposite values it is not determined: the energies of the projection rule, which hardly sees what happens there, are then wrong without a sign.

#include <string>

#include "karcher/field/layout.hpp"

namespace karcher {

struct Spread {
  static constexpr double wide = 0.5, opposite = 1 - 1e-6;

  double ratio = 0;      ///< ManifoldOps::cut_ratio of the two values of a cell that lie farthest apart; wide: 90 degrees of 180
  std::string sentence;  ///< "the values of the field "u" differ by 180 of at most 180 degrees within the cell around (0.5, 0, 0)"; empty for ratio 0
};

/// The widest of all cells of all fields. \param u  the values that this rank sees suffice. Collective.
Spread widest_spread(const Layout& layout, const Configuration& u);

}  // namespace karcher
