// A manifold of your own: the projective plane, whose points are lines through the origin. Nematic directors live there: n and -n are the same.
#include <cmath>
#include <iostream>
#include <numbers>

#include "karcher/karcher.hpp"
#include "karcher/testing/manifold_laws.hpp"
using namespace karcher;

struct Line {  // a line is one of its two unit vectors; all is as on the sphere, but the logarithm goes to the nearer one
  static constexpr std::string_view name = "RP2";
  static constexpr int ambient = 3, dim = 2;
  static constexpr double injectivity_radius = std::numbers::pi / 2;
  template <class T>
  static Vec3<T> exp(const Vec3<T>& p, const Vec3<T>& a) {
    return Sphere<2>::exp(p, a);
  }
  template <class T>
  static Vec3<T> log(const Vec3<T>& p, const Vec3<T>& q) {
    const T side = select(base(dot(p, q)) < Base<T>(0.0), T(-1.0), T(1.0));
    return Sphere<2>::log(p, side * q);
  }
  template <class T>
  static T inner(const Vec3<T>&, const Vec3<T>& a, const Vec3<T>& b) {
    return dot(a, b);
  }
  template <class T>
  static Mat<T, 3, 2> frame(const Vec3<T>& p) {
    return Sphere<2>::frame(p);
  }
  static Vec3<double> origin() { return {{0, 0, 1}}; }
};

int main() {
  for (const std::string& broken : manifold_laws<Line>()) return std::cerr << broken << '\n', 1;

  // A defect that no field of unit vectors has: around the hole of an annulus, the director turns by half a turn.
  const GeometricSpace<Line, 2> space(generate({"annulus", {{"cells", {48, 8}}, {"order", {2}}}}), 2);
  auto n = space.interpolate([](const Vec3<double>& x) {
    const double angle = 0.5 * std::atan2(x[1], x[0]);
    return Vec3<double>{{std::cos(angle), std::sin(angle), 0}};
  });
  n.fix("inner");
  n.fix("outer");
  const StepReport report = minimize(integral(space, Harmonic<double>{1.0}), n);
  const double exact = std::numbers::pi / 4 * std::log(2.0);
  std::cout << report << "\nthe exact energy is pi/4 log 2 = " << exact << '\n';
  write_vtu("own_manifold.vtu", n);
  return std::abs(report.energy - exact) < 1e-6 ? 0 : 1;
}
