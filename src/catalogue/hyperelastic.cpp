#include "karcher/energy/hyperelastic.hpp"

#include <fmt/format.h>

#include "catalogue/density_terms.hpp"
#include "catalogue/flat_reference.hpp"
#include "karcher/manifold/euclidean.hpp"

namespace karcher::catalogue {
namespace {

/// lambda, which is refused where the energy would have no lower bound.
ParameterValue bounded(const std::string& material, const ParameterValue& mu, const ParameterValue& lambda) {
  ParameterValue checked;
  checked.depends_on_t = mu.depends_on_t || lambda.depends_on_t;
  checked.function = [=](const Vec3<double>& x, double t) {
    const double m = mu(x, t), l = lambda(x, t);
    if (material == "neo-hooke" ? l < 0 : !(l > -2 * m / 3))
      throw InputError(fmt::format("hyperelastic: lambda is {:.6g}; it (and Poisson's ratio) must be {} for the material \"{}\".", l,
                                   material == "neo-hooke" ? std::string("at least 0") : fmt::format("greater than -2/3 mu = {:.6g}", -2 * m / 3),
                                   material));
    return l;
  };
  return checked;
}

template <template <class> class Material>
std::unique_ptr<Term> solid(const EnergyInfo& info, const TermInput& input, const std::vector<std::string>& keys) {
  const auto make = [&]<int D>() -> std::unique_ptr<Term> {
    using I = LinearInterpolation<Euclidean<D>, D, NativeScalar>;
    return std::make_unique<DensityTerm<VaryingDensity<Material>, D, I>>(term_info(info, input), input, VaryingDensity<Material>{}, keys);
  };
  return input.region.dim == 3 ? make.template operator()<3>() : make.template operator()<2>();
}

std::unique_ptr<Term> make_hyperelastic(const EnergyInfo& info, const TermInput& given) {
  TermInput input = given;
  const Field& deformation = input.field(0);
  if (deformation.manifold->dim != input.region.dim)
    throw InputError(
        fmt::format("hyperelastic: the deformation \"{}\" has values in {}, but the region \"{}\" has dimension {}; a solid has a region of "
                    "dimension 3 and values in R3, plane strain a region of dimension 2 and values in R2.",
                    deformation.name, deformation.manifold->name, input.region.name, input.region.dim));
  if (input.region.dim == 2) {
    require_flat(input, "hyperelastic in plane strain", "solids have a region of dimension 3");
    // Values are polynomials, as in solids.
    for (const CellKind kind : {CellKind::triangle, CellKind::quadrilateral})
      input.quadrature_degree.try_emplace(kind, 2 * deformation.space->order() + 1);
  }
  const std::string& material = input.choices.at("material");
  std::vector<std::string> keys = parameter_keys(info, input);
  if (const auto lambda = input.parameters.find("lambda"); lambda != input.parameters.end())
    lambda->second = bounded(material, input.parameters.at("mu"), lambda->second);
  if (const auto normalised = input.choices.find("normalised"); normalised != input.choices.end()) {
    keys.push_back("normalised");
    input.parameters[keys.back()] = normalised->second == "true" ? 1.0 : 0.0;
  }
  return material == "neo-hooke"                ? solid<NeoHooke>(info, input, keys)
         : material == "saint-venant-kirchhoff" ? solid<SaintVenantKirchhoff>(info, input, keys)
         : material == "mooney-rivlin"          ? solid<MooneyRivlin>(info, input, keys)
         : material == "hencky"                 ? solid<Hencky>(info, input, keys)
                                                : solid<ExpHencky>(info, input, keys);
}

}  // namespace

std::vector<Entry> hyperelastic_entries() {
  EnergyInfo e;
  e.type = "hyperelastic";
  e.description =
      "Hyperelastic solids, in the plane in plane strain. F = grad m, J = det F, E = (F^T F - I)/2, V = (F F^T)^(1/2), kappa = lambda + 2 mu/3:\n"
      "neo-hooke: mu/2 (|F|^2 - 3 - 2 ln J) + lambda/2 (ln J)^2\n"
      "saint-venant-kirchhoff: mu |E|^2 + lambda/2 (tr E)^2\n"
      "mooney-rivlin: a |F|^2 + b |cof F|^2 + c J^2 - (2 a + 4 b + 2 c) ln J (Ciarlet 1988)\n"
      "hencky: mu |dev log V|^2 + kappa/2 (ln J)^2\n"
      "exp-hencky: mu/k exp(k |dev log V|^2) + kappa/(2 k_hat) exp(k_hat (ln J)^2) (Neff, Ghiba, Lankeit 2015)\n"
      "Infinite where J <= 0. Default quadrature: degree 2 k + 1, k the order of the deformation.";
  e.dimensions = {2, 3};
  e.fields = {{.key = "deformation",
               .manifolds = {&manifold_ops<Euclidean<3>>(), &manifold_ops<Euclidean<2>>()},
               .description = "position; values in R3 for solids, in R2 for plane strain",
               .moves = true}};
  const Condition moduli{"material", {"neo-hooke", "saint-venant-kirchhoff", "hencky", "exp-hencky"}}, rivlin{"material", {"mooney-rivlin"}},
      exponential{"material", {"exp-hencky"}};
  const auto parameter = [](const char* name, const char* unit, const char* description, const Condition& only, double minimum, bool allowed) {
    return Parameter{
        .name = name, .unit = unit, .description = description, .default_value = {}, .minimum = minimum, .minimum_allowed = allowed, .only = only};
  };
  constexpr const char* stress = "force/length^2";
  e.parameters = {
      parameter("mu", stress, "shear modulus", moduli, 0, false),
      parameter("lambda", stress, "first Lame parameter; at least 0 for neo-hooke, else greater than -2/3 mu", moduli,
                -std::numeric_limits<double>::infinity(), true),
      parameter("a", stress, "factor of |F|^2; mu = 2 (a + b)", rivlin, 0, false),
      parameter("b", stress, "factor of |cof F|^2; lambda = 4 (b + c)", rivlin, 0, true),
      parameter("c", stress, "factor of J^2", rivlin, 0, true),
      parameter("k", "1", "exponent of the change of shape", exponential, 0, false),
      parameter("k_hat", "1", "exponent of the change of volume", exponential, 0, false),
  };
  e.choices = {
      {"material", {"neo-hooke", "saint-venant-kirchhoff", "mooney-rivlin", "hencky", "exp-hencky"}, "density"},
      {"volumetric", {"ciarlet"}, "what the change of volume costs: ciarlet is c J^2 - (2 a + 4 b + 2 c) ln J", rivlin},
      {"normalised",
       {"false", "true"},
       "true: the energy is less its value without strain, 3 a + 3 b + c or mu/k + kappa/(2 k_hat)",
       Condition{"material", {"mooney-rivlin", "exp-hencky"}}},
  };
  e.lame = true;
  e.stress_free = true;
  e.constant = Condition{"normalised", {"false"}};
  return {{e, &make_hyperelastic}};
}

}  // namespace karcher::catalogue
