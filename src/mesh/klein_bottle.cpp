#include "mesh/klein_bottle.hpp"

#include <cmath>

namespace karcher {
namespace {

/// constant + sum_k cosine[k] cos((k + 1) u) + sine[k] sin((k + 1) u)
struct TrigonometricPolynomial {
  double constant;
  std::array<double, 4> cosine, sine;

  double operator()(double u) const {
    double sum = constant;
    for (std::size_t k = 0; k < 4; ++k) {
      const double angle = static_cast<double>(k + 1) * u;
      sum += cosine[k] * std::cos(angle) + sine[k] * std::sin(angle);
    }
    return sum;
  }
};

constexpr TrigonometricPolynomial x{0.1009, {-0.0975, -0.0206, 0.0215, 0.0036}, {-0.1317, 0.0836, -0.0152, 0.0064}};
constexpr TrigonometricPolynomial z{0.4433, {-0.4107, 0.0081, -0.0322, 0.0031}, {-0.0473, -0.0019, -0.0096, 0.0032}};
constexpr TrigonometricPolynomial radius{0.1440, {0.0440, -0.0126, -0.0120, -0.0031}, {0.0645, 0.0434, 0.0127, 0.0096}};
constexpr TrigonometricPolynomial turn{0.1104, {0.0789, -0.2142, -0.0329, 0.0388}, {-1.1345, 0.2082, -0.0237, 0.0246}};

}  // namespace

Vec3<double> klein_bottle(double u, double v) {
  const double phi = u / 2 + turn(u), r = radius(u);
  return {{x(u) + r * std::sin(v) * std::cos(phi), r * std::cos(v), z(u) - r * std::sin(v) * std::sin(phi)}};
}

}  // namespace karcher
