// The harmonic map of a square into the sphere with the boundary values of the inverse stereographic projection.
#include <iostream>

#include "karcher/karcher.hpp"
using namespace karcher;

struct Dirichlet {  // 1/2 |grad u|^2
  template <class Jet>
  auto operator()(const Jet& u) const {
    return 0.5 * (norm2(u.d[0]) + norm2(u.d[1]));
  }
};

int main(int argc, char** argv) {
  const GeometricSpace<Sphere<2>, 2> space(read_gmsh(argc > 1 ? argv[1] : "square.msh"), 2);
  auto u = space.interpolate([](const Vec3<double>& x) {
    const double bump = (1 - x[0] * x[0]) * (1 - x[1] * x[1]);  // off the solution, inside
    return Sphere<2>::project(Vec3<double>{{2 * x[0] + bump, 2 * x[1], norm2(x) - 1}});
  });
  u.fix("boundary");
  const StepReport report = minimize(integral(space, Dirichlet{}), u, {.gradient_tolerance = 1e-10});
  std::cout << report << "\nthe exact map has the energy 6.963358\n";
  write_vtu("hello_sphere.vtu", u);
  return report.status == Status::converged ? 0 : 1;
}
