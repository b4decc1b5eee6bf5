#pragma once
// Problems of one or two unknowns whose energy, gradient and Hessian are given one by one, so that what the solver makes of them is known exactly.

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "karcher/solve/exchange.hpp"
#include "solve/small_problem.hpp"

namespace karcher::testing {

/// |s|_M of a unit step of one unknown: half the measure 1 belongs to each node, and lengths are counted in halves of the diagonal 1, so M = 1/2 / (1/2)^2.
inline const double unit = std::sqrt(2.0);

/// Value, slope and curvature at x; they need not fit together.
struct Local {
  double value = 0, slope = 0, curvature = 0;
};

/// x at the right end of [0, 1]; the left end is fixed.
struct OneUnknown : SmallProblem {
  explicit OneUnknown(std::function<Local(double)> f, double start = 0)
      : SmallProblem(
            1, manifold_by_name("R1"),
            [f = std::move(f)](const std::vector<const double*>& nodes, const Vec3<double>&, double, double* g, double* h) {
              const Local at = f(*nodes[1]);
              if (g) g[1] = at.slope;
              if (h) h[3] = at.curvature;
              return CellValue{at.value, std::isfinite(at.value) ? Trouble::none : Trouble::infinite_energy};
            },
            {0, start}, left_fixed()) {}
  double x() {
    complete(*layout, u);
    return value(1);
  }

 private:
  static std::vector<char> left_fixed() {
    const auto mesh = line_mesh(1);
    const Space space(mesh, mesh->regions.at("all"), 1);
    return {space.position(0)[0] < 0.5, space.position(1)[0] < 0.5};
  }
};

/// Value, gradient and Hessian at (a, b).
struct Local2 {
  double value = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;
};

/// a and b at the ends of [0, 1].
struct TwoUnknowns : SmallProblem {
  explicit TwoUnknowns(std::function<Local2(double, double)> f, double a = 0, double b = 0)
      : SmallProblem(1, manifold_by_name("R1"),
                     [f = std::move(f)](const std::vector<const double*>& nodes, const Vec3<double>&, double, double* g, double* h) {
                       const Local2 at = f(*nodes[0], *nodes[1]);
                       if (g) g[0] = at.a, g[1] = at.b;
                       if (h) h[0] = at.aa, h[1] = h[2] = at.ab, h[3] = at.bb;
                       return CellValue{at.value};
                     },
                     {a, b}) {}
  double a() {
    complete(*layout, u);
    return value(0);
  }
  double b() {
    complete(*layout, u);
    return value(1);
  }
};

}  // namespace karcher::testing
