#include "karcher/manifold/drawing.hpp"

#include <algorithm>

namespace karcher {

std::string Drawing::complaint(int ambient) const {
  const auto count = coordinates.size();
  const bool right = glyph == Glyph::none        ? count == 0
                     : glyph == Glyph::frame     ? count == 4
                     : glyph == Glyph::ellipsoid ? count == 3 || count == 6
                                                 : count == 2 || count == 3;
  if (right && std::ranges::all_of(coordinates, [&](int c) { return c >= 0 && c < ambient; })) return {};
  return "A drawing takes its glyph from ambient coordinates, numbered from 0 to " + std::to_string(ambient - 1) +
         ": 2 or 3 of them for an arrow or a rod, 4 for a frame, 3 or 6 for an ellipsoid, none without a glyph.";
}

}  // namespace karcher
