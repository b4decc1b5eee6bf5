// An energy of your own: a magnetic wall between two domains. Exchange A wants no change, anisotropy K wants the magnetisation along the x axis.
#include <cmath>
#include <iostream>

#include "karcher/karcher.hpp"
#include "karcher/testing/energy_laws.hpp"
using namespace karcher;

struct Wall {
  double A, K;  // force, force/length^2
  double width;

  /// A/2 |m'|^2 + K (1 - m_x^2), K half as large in a strip around the middle (smoothly: `x` is the place, a pack of numbers or one)
  template <class X, class Jet>
  auto operator()(const X& x, const Jet& m) const {
    const auto k = K * (1.0 - 0.5 * exp(-(x[0] * x[0]) / (width * width)));
    return 0.5 * A * norm2(m.d[0]) + k * (1.0 - m.value[0] * m.value[0]);
  }
};

int main() {
  const GeometricSpace<Sphere<2>, 1> space(generate({"interval", {{"length", {40}}, {"lower", {-20, 0, 0}}, {"cells", {200}}}}), 3, Rule::geodesic);
  auto m = space.interpolate([](const Vec3<double>& x) {
    const double c = std::tanh(x[0]);
    return Vec3<double>{{c, std::sqrt(1 - c * c), 0}};
  });
  m.fix("boundary");

  const auto uniform = integral(space, Wall{1.0, 0.5, 1e-3}), soft = integral(space, Wall{1.0, 0.5, 1.0});
  for (const std::string& broken : energy_laws(soft.functional(m), m.values())) return std::cerr << broken << '\n', 1;
  const StepReport free = minimize(uniform, m), pinned = minimize(soft, m);
  std::cout << "energy of a wall " << free.energy << ", exactly 2 sqrt(2 A K) = " << 2 * std::sqrt(2 * 1.0 * 0.5) << "\nin the soft strip: " << pinned
            << '\n';
  write_vtu("own_energy.vtu", m);
  return std::abs(free.energy - 2) < 1e-6 && pinned.energy < free.energy ? 0 : 1;
}
