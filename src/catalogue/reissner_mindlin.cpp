#include "karcher/energy/reissner_mindlin.hpp"

#include <fmt/format.h>

#include <utility>

#include "catalogue/density_terms.hpp"
#include "catalogue/prestretch.hpp"
#include "catalogue/shell_quadrature.hpp"
#include "karcher/assembly/nodal_normals.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/sphere.hpp"

namespace karcher::catalogue {
namespace {

/// The start with the stress-free directors.
Configuration stress_free_directors(const TermInput& input) {
  Configuration u = input.start();
  const auto choice = input.choices.find("reference_director");
  if (choice != input.choices.end() && choice->second == "initial") return u;
  const auto whole = input.mesh->regions.find(input.region.name);  // of which this rank may hold a part
  const std::vector<Vec3<double>> normals = nodal_normals(*input.field(1).space, whole != input.mesh->regions.end() ? whole->second : input.region,
                                                          {*input.mesh, input.reference_position, input.reference_order},
                                                          input.mirrors.empty() ? std::vector<unsigned char>() : input.mirrors[1]);
  for (std::size_t n = 0; n < normals.size(); ++n)
    if (norm2(normals[n]) > 0) std::copy(normals[n].e.begin(), normals[n].e.end(), u.at(input.fields[1], static_cast<int>(n), 3));
  return u;
}

/// The shell with the strains of its reference, whose directors are those of the nodes, interpolated as the field is.
template <class Directors>
class ReissnerMindlinTerm : public DensityTerm<VaryingDensity<ReissnerMindlin>, 2, LinearInterpolation<Euclidean<3>, 2, NativeScalar>, Directors> {
  using T = NativeScalar;
  using Base = DensityTerm<VaryingDensity<ReissnerMindlin>, 2, LinearInterpolation<Euclidean<3>, 2, T>, Directors>;

 public:
  ReissnerMindlinTerm(TermInfo info, const TermInput& input, const std::vector<std::string>& keys, std::size_t strains_begin)
      : Base(std::move(info), input, {}, keys), directors_(stress_free_directors(input)) {
    typename Base::States states;
    const std::vector<double> diameters = cell_diameters(input);
    for (int b = 0; b < this->batch_count(); ++b) {
      const MaskOf<T> known = this->template gather<1>(directors_, b, states);
      for (int q = 0; q < this->batches().kind(b).quadrature->size(); ++q) {
        const MaskOf<T> defined = known & this->template move_to<1>(b, q, states);
        const auto reference = this->batches().template reference<2>(b, q);
        for (int lane = 0; lane < native_width; ++lane)
          if (!karcher::lane(select(defined, T(1.0), T(0.0)), lane))
            throw InputError(fmt::format("The stress-free directors around ({:.6g}, {:.6g}, {:.6g}) are too far apart to have a mean.",
                                         karcher::lane(reference.x[0], lane), karcher::lane(reference.x[1], lane),
                                         karcher::lane(reference.x[2], lane)));
        const auto& d = std::get<1>(states).interpolation.jet();
        const auto& m = reference.tangent;
        const std::array<T, 6> strains{dot(m[0], d.d[0]), dot(m[1], d.d[1]),  dot(m[0], d.d[1]),
                                       dot(m[1], d.d[0]), dot(m[0], d.value), dot(m[1], d.value)};
        for (std::size_t i = 0; i < strains.size(); ++i) this->parameter(b, q, strains_begin + i) = strains[i];
        for (int lane = 0; lane < native_width; ++lane) {
          const double diameter = diameters[static_cast<std::size_t>(this->batch(b).cells[static_cast<std::size_t>(lane)])];
          set_lane(this->parameter(b, q, strains_begin + 6), lane, diameter * diameter);
        }
      }
    }
  }
  std::vector<double> stress_free(int field) const override {
    return field == this->fields()[1] ? directors_.values[static_cast<std::size_t>(field)] : std::vector<double>();
  }

 private:
  Configuration directors_;
};

std::unique_ptr<Term> make_part(const EnergyInfo& info, const TermInput& given) {
  TermInput input = given;
  choose_shell_quadrature(input);
  std::vector<std::string> keys = parameter_keys(info, input);
  const std::size_t strains_begin = keys.size();
  const SelectiveFactors factors = selective_factors(input.part);
  for (const auto& [name, value] : {std::pair("bending0[11]", 0.0),
                                    {"bending0[22]", 0.0},
                                    {"bending0[12]", 0.0},
                                    {"bending0[21]", 0.0},
                                    {"shear0[1]", 0.0},
                                    {"shear0[2]", 0.0},
                                    {"diameter2", 1.0},
                                    {"membrane_constant", factors.membrane_constant},
                                    {"membrane_slope", factors.membrane_slope},
                                    {"shear_constant", factors.shear_constant},
                                    {"shear_slope", factors.shear_slope},
                                    {"rest", factors.rest}}) {
    keys.emplace_back(name);
    input.parameters[name] = value;
  }
  return with_rule<Sphere<2>, 2>(input.field(1), [&]<class I>() -> std::unique_ptr<Term> {
    return std::make_unique<ReissnerMindlinTerm<I>>(term_info(info, input), input, keys, strains_begin);
  });
}

std::unique_ptr<Term> make_reissner_mindlin(const EnergyInfo& info, const TermInput& input) {
  return selectively(input, [&](const TermInput& i) { return make_part(info, i); });
}

}  // namespace

std::vector<Entry> reissner_mindlin_entries() {
  EnergyInfo e;
  e.type = "reissner-mindlin";
  e.description =
      "Shell with one director d of length one and Green's strains (Simo, Fox 1989; Mueller, Bischoff 2022), in orthonormal directions of the "
      "reference:\n"
      "eps_ab = (m_a.m_b - m0_a.m0_b)/2, kappa_ab = sym(m_a.d_b) - sym(m0_a.d0_b), gamma_a = m_a.d - m0_a.d0\n"
      "W = h/2 eps:C:eps + h^3/24 kappa:C:kappa + k_s mu h/2 |gamma|^2, e:C:e = 2 lambda mu/(lambda + 2 mu) (tr e)^2 + 2 mu |e|^2\n"
      "d0 is the unit normal of the reference at the nodes, on one side of the surface, interpolated as d is; or what the director is initially.\n"
      "Default quadrature: that of cosserat-shell.";
  e.dimensions = {2};
  e.fields = {{.key = "deformation", .manifolds = {&manifold_ops<Euclidean<3>>()}, .description = "position of the midsurface", .moves = true},
              {.key = "director",
               .manifolds = {&manifold_ops<Sphere<2>>()},
               .description = "direction of the material fibre across the shell",
               .normal = true}};
  e.parameters = {
      {.name = "thickness", .unit = "length", .description = "thickness h of the shell", .default_value = {}, .minimum = 0, .minimum_allowed = false},
      {.name = "mu", .unit = "force/length^2", .description = "shear modulus", .default_value = {}, .minimum = 0, .minimum_allowed = false},
      {.name = "lambda", .unit = "force/length^2", .description = "first Lame parameter; 3 lambda + 2 mu > 0", .default_value = {}},
      {.name = "shear_correction", .unit = "1", .description = "k_s", .default_value = 5.0 / 6, .minimum = 0, .minimum_allowed = false},
      prestretch_parameter(),
  };
  e.choices = {{"reference_director", {"normal", "initial"}, "d0: normal to the reference, or the initial values of the director"},
               integration_choice()};
  e.parts = {"membrane", "bending", "shear"};
  e.lame = true;
  e.stress_free = true;
  e.prestretch = true;
  return {{e, &make_reissner_mindlin}};
}

}  // namespace karcher::catalogue
