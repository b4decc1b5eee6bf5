#include "mesh/klein_bottle.hpp"

#include <cmath>

namespace karcher {

Vec3<double> klein_bottle(double u, double v) {
  const double r = 0.55 + 0.3 * std::sin(u);
  const double x = 0.5 * (1 - std::cos(u)) * (1 - std::cos(u)) * 0.5 * (1 - 0.8 * std::sin(u)), z = 2 * (1 - std::cos(u));
  const double theta = u / 2;
  return {{x + r * std::sin(v) * std::cos(theta), r * std::cos(v), z - r * std::sin(v) * std::sin(theta)}};
}

}  // namespace karcher
