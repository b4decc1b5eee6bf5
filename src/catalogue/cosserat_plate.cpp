#include "karcher/energy/cosserat_plate.hpp"

#include <fmt/format.h>

#include "catalogue/density_terms.hpp"
#include "catalogue/flat_reference.hpp"
#include "catalogue/shell_quadrature.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"

namespace karcher::catalogue {
namespace {

/// lambda, which is refused where it is negative: the energy would have no lower bound for det U -> 0.
ParameterValue bounded(ParameterValue lambda) {
  const auto check = [](double value) {
    if (value < 0) throw InputError(fmt::format("cosserat-plate: lambda is {:.6g}; it (and Poisson's ratio) must be at least 0.", value));
    return value;
  };
  if (lambda.function)
    lambda.function = [=, f = lambda.function](const Vec3<double>& x, double t) { return check(f(x, t)); };
  else
    check(lambda.constant);
  return lambda;
}

std::unique_ptr<Term> make_plate(const EnergyInfo& info, const TermInput& given) {
  require_flat(given, info.type, "cosserat-shell takes any surface");
  TermInput input = given;
  choose_shell_quadrature(input);
  input.parameters.at("lambda") = bounded(input.parameters.at("lambda"));
  return DensityTerms<CosseratPlate, Euclidean<3>, Rotation>::make<2>(info, input);
}

}  // namespace

std::vector<Entry> cosserat_plate_entries() {
  EnergyInfo e;
  e.type = "cosserat-plate";
  e.description =
      "Cosserat plate with a flat reference in the plane z = 0 (Neff 2004; Sander, Neff, Birsan 2016).\n"
      "U = R^T (d_1 m | d_2 m | R e_3), K_b = (R^T d_1 R e_3 | R^T d_2 R e_3 | 0), K = R^T grad R, W = h Wmemb(U) + h^3/12 Wbend(K_b) + h Wcurv(K):\n"
      "Wmemb(U) = mu |sym(U - I)|^2 + mu_c |skew(U - I)|^2 + mu lambda/(2 mu + lambda) 1/2 ((det U - 1)^2 + (1/det U - 1)^2)\n"
      "Wbend(K_b) = mu |sym K_b|^2 + mu_c |skew K_b|^2 + mu lambda/(2 mu + lambda) (tr K_b)^2\n"
      "Wcurv(K) = mu L_c^(1+p) |K|^(1+p). Infinite where det U <= 0.\n"
      "Default quadrature: that of cosserat-shell.";
  e.dimensions = {2};
  e.fields = {{.key = "deformation", .manifolds = {&manifold_ops<Euclidean<3>>()}, .description = "position of the midsurface", .moves = true},
              {.key = "rotation", .manifolds = {&manifold_ops<Rotation>()}, .description = "microrotation; its columns are the directors"}};
  e.parameters = {
      {.name = "thickness", .unit = "length", .description = "thickness h of the plate", .default_value = {}, .minimum = 0, .minimum_allowed = false},
      {.name = "mu", .unit = "force/length^2", .description = "shear modulus", .default_value = {}, .minimum = 0, .minimum_allowed = false},
      {.name = "lambda", .unit = "force/length^2", .description = "first Lame parameter", .default_value = {}, .minimum = 0},
      {.name = "mu_c", .unit = "force/length^2", .description = "Cosserat couple modulus", .default_value = {}, .minimum = 0},
      {.name = "L_c",
       .unit = "length",
       .description = "internal length; at most thickness/1000 to compare with classical plates",
       .default_value = {},
       .minimum = 0,
       .minimum_allowed = false},
      {.name = "p", .unit = "1", .description = "the curvature energy is of the power 1 + p", .default_value = 1.0, .minimum = 1},
  };
  e.parts = {"membrane", "bending", "curvature"};
  e.lame = true;
  e.stress_free = true;
  return {{e, &make_plate}};
}

}  // namespace karcher::catalogue
