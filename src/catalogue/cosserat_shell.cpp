#include "karcher/energy/cosserat_shell.hpp"

#include "catalogue/entry.hpp"
#include "catalogue/prestretch.hpp"
#include "catalogue/shell_quadrature.hpp"
#include "karcher/assembly/shell_term.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"

namespace karcher::catalogue {

std::vector<Entry> cosserat_shell_entries() {
  EnergyInfo e;
  e.type = "cosserat-shell";
  e.description =
      "Curved six-parameter Cosserat shell with all terms up to h^5 (Birsan, Ghiba, Martin, Neff 2019; Birsan 2021; Nebel, Sander, Birsan, Neff "
      "2023).\n"
      "E = Q^T grad m - a, K = axl(Q^T grad Q), b, c, H, K_G of the reference surface:\n"
      "W = (h - K_G h^3/12) Wm(E) + (h^3/12 - K_G h^5/80) Wm(E b + c K) + h^3/6 Wmixt(E, c K b - 2H c K) + h^5/80 Wmp((E b + c K) b)\n"
      "  + (h - K_G h^3/12) Wcurv(K) + (h^3/12 - K_G h^5/80) Wcurv(K b) + h^5/80 Wcurv(K b^2)\n"
      "Wcurv(S) = mu L_c^2 (b1 |dev sym S|^2 + b2 |skew S|^2 + b3 (tr S)^2). Requires h |kappa| < 2 for both principal curvatures.\n"
      "Parts: membrane (the term in Wm(E)), bending (the terms in E b + c K and the mixed one), curvature (those in Wcurv).\n"
      "Default quadrature: degree 2, 5, 7 on triangles and 3, 5, 7 on quadrilaterals where the higher of the two field orders is 1, 2, 3.";
  e.dimensions = {2};
  e.fields = {{.key = "deformation", .manifolds = {&manifold_ops<Euclidean<3>>()}, .description = "position of the midsurface", .moves = true},
              {.key = "rotation", .manifolds = {&manifold_ops<Rotation>()}, .description = "microrotation; its columns are the directors"}};
  e.parameters = {
      {.name = "thickness", .unit = "length", .description = "thickness h of the shell", .default_value = {}, .minimum = 0, .minimum_allowed = false},
      {.name = "mu", .unit = "force/length^2", .description = "shear modulus", .default_value = {}, .minimum = 0, .minimum_allowed = false},
      {.name = "lambda", .unit = "force/length^2", .description = "first Lame parameter; 3 lambda + 2 mu > 0", .default_value = {}},
      {.name = "mu_c",
       .unit = "force/length^2",
       .description = "Cosserat couple modulus; mu for a classical shell; 0 leaves the drilling rotation to L_c",
       .default_value = {},
       .minimum = 0},
      {.name = "L_c",
       .unit = "length",
       .description = "internal length; at most thickness/1000 to compare with classical shells",
       .default_value = {},
       .minimum = 0,
       .minimum_allowed = false},
      {.name = "b", .unit = "1", .description = "coefficients b1, b2, b3 of the curvature energy", .default_value = 1.0, .minimum = 0, .size = 3},
      prestretch_parameter(),
  };
  e.choices = {{"coupling", {"default", "birsan-2021"}, "form of the membrane and bending energy; birsan-2021: the refined Wcoss of Birsan (2021)"},
               integration_choice()};
  e.parts = {"membrane", "bending", "curvature"};
  e.lame = true;
  e.stress_free = true;
  e.prestretch = true;
  return {{e, [](const EnergyInfo& info, const TermInput& input) {
             return selectively(input, [&](const TermInput& i) { return make_shell_term(term_info(info, i), i); });
           }}};
}

}  // namespace karcher::catalogue
