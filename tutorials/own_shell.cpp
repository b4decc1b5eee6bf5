// A shell of your own: the Reissner-Mindlin model, a position m and a unit director n at every point of a cylinder, under a load that moves around its rim.
#include <iostream>

#include "karcher/karcher.hpp"
using namespace karcher;

struct ReissnerMindlin {  // stretch, bending and transverse shear of Simo and Fox (1989); derivatives and s.b in the orthonormal directions s.tangent
  double h, mu, lambda;
  template <class S, class M, class N>
  auto operator()(const S& s, const M& m, const N& n) const {
    Mat<std::decay_t<decltype(m.value[0])>, 2, 2> e, k;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        e(a, b) = 0.5 * (dot(m.d[a], m.d[b]) - (a == b));
        k(a, b) = 0.5 * (dot(m.d[a], n.d[b]) + dot(m.d[b], n.d[a])) + s.b(a, b);
      }
    const auto stress = [&](const auto& x) { return mu * norm2(x) + mu * lambda / (lambda + 2 * mu) * trace(x) * trace(x); };
    const auto g1 = dot(m.d[0], n.value), g2 = dot(m.d[1], n.value);
    return h * stress(e) + h * h * h / 12 * stress(k) + 5.0 / 12 * h * mu * (g1 * g1 + g2 * g2);
  }
};

int main() {
  Problem p(generate({"cylinder", {{"height", {2}}, {"cells", {12, 6}}, {"order", {2}}}}), "a shell of my own");
  const auto m = p.field<Euclidean<3>>("m", {.order = 2, .moves = true});
  const auto n = p.field<Sphere<2>>("n", {.order = 2, .rule = Rule::geodesic}, [](const MeshPoint& s) { return s.normal; });
  p.add(integral<2>(ReissnerMindlin{0.02, 1e6, 1e6}, m, n));
  p.add(load(m, "top", [](const Vec3<double>& x, double t) {
    return Vec3<double>{{-30 * std::exp(4 * (x[0] * std::cos(t) + x[1] * std::sin(t) - 1)), 0, 0}};
  }));
  p.fix(m, "bottom");
  p.fix(n, "bottom");
  p.probe("rim", m, {{1, 0, 2}}, "displacement");
  const Solution u = solve(p, {.steps = 10}, {.gradient_tolerance = 1e-9});
  u.save("own_shell");  // summary, pictures for ParaView, and a page that opens by double click
  const Vec3<double> x{{std::cos(1.0), std::sin(1.0), 2}}, moved = u.at(m, x);
  std::cout << u.report().steps.back() << "\nthe rim under the load moved by " << moved[0] - x[0] << '\n';
  return u.converged() && moved[0] - x[0] < -0.01 ? 0 : 1;
}
