#include "karcher/energy/cosserat_rod.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "catalogue/density_terms.hpp"
#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/rotation.hpp"

namespace karcher::catalogue {
namespace {

/// A stiffness as function of other parameters.
template <class F>
ParameterValue of_parameters(const TermInput& input, std::vector<std::string> names, F f) {
  std::vector<ParameterValue> from;
  ParameterValue result;
  for (const std::string& name : names) {
    from.push_back(input.parameters.at(name));
    result.depends_on_t = result.depends_on_t || from.back().depends_on_t;
  }
  result.function = [from = std::move(from), f](const Vec3<double>& x, double t) {
    std::vector<double> p;
    for (const ParameterValue& value : from) p.push_back(value(x, t));
    return f(p);
  };
  return result;
}

/// Area and second moments about d_1 and d_2.
struct Section {
  double area, about_1, about_2;
};
Section disc(double r) {
  const double square = r * r;
  return {std::numbers::pi * square, std::numbers::pi / 4 * square * square, std::numbers::pi / 4 * square * square};
}

/// The section of its numbers, whose names are in `names`.
Section section_of(const std::string& shape, double first, double second) {
  if (shape == "rectangle") return {first * second, first * std::pow(second, 3) / 12, std::pow(first, 3) * second / 12};
  if (shape == "circle") return disc(first);
  if (!(second <= first)) throw InputError(fmt::format("wall is {}, but the radius of the tube is {}; the wall is at most as thick.", second, first));
  const Section outer = disc(first), inner = disc(first - second);
  return {outer.area - inner.area, outer.about_1 - inner.about_1, outer.about_2 - inner.about_2};
}

/// G of E and Poisson's ratio.
double shear_modulus(const std::vector<double>& p) { return p[0] / (2 * (1 + p[1])); }

/// A and K of a cross-section: A_1 = A_2 = k_s G A, A_3 = E A, K_1 = E I_1, K_2 = E I_2, K_3 = k_t G (I_1 + I_2).
void add_stiffnesses(TermInput& input, const std::string& shape) {
  std::vector<std::string> names{"young", "poisson", "shear_correction", "torsion_correction"};
  if (shape == "rectangle")
    names.insert(names.end(), {"width", "height"});
  else
    names.insert(names.end(), {"radius", shape == "tube" ? "wall" : "radius"});
  const auto add = [&](const std::string& name, double (*stiffness)(const Section&, const std::vector<double>&)) {
    input.parameters[name] =
        of_parameters(input, names, [shape, stiffness](const std::vector<double>& p) { return stiffness(section_of(shape, p[4], p[5]), p); });
  };
  for (const char* name : {"A[0]", "A[1]"})
    add(name, [](const Section& s, const std::vector<double>& p) { return p[2] * shear_modulus(p) * s.area; });
  add("A[2]", [](const Section& s, const std::vector<double>& p) { return p[0] * s.area; });
  add("K[0]", [](const Section& s, const std::vector<double>& p) { return p[0] * s.about_1; });
  add("K[1]", [](const Section& s, const std::vector<double>& p) { return p[0] * s.about_2; });
  add("K[2]", [](const Section& s, const std::vector<double>& p) { return p[3] * shear_modulus(p) * (s.about_1 + s.about_2); });
}

/// The rod with the strains of its start as stress-free ones.
template <class Rotations>
class RodTerm : public DensityTerm<VaryingDensity<CosseratRod>, 1, LinearInterpolation<Euclidean<3>, 1, NativeScalar>, Rotations> {
  using T = NativeScalar;
  using Base = DensityTerm<VaryingDensity<CosseratRod>, 1, LinearInterpolation<Euclidean<3>, 1, T>, Rotations>;
  static constexpr std::size_t strains_begin = 6;  // behind A and K

 public:
  RodTerm(TermInfo info, const TermInput& input, const std::vector<std::string>& keys)
      : Base(std::move(info), input, {}, keys), start_(input.start()) {
    typename Base::States states;
    for (int b = 0; b < this->batch_count(); ++b) {
      const MaskOf<T> known = this->template gather<1>(start_, b, states);
      for (int q = 0; q < this->batches().kind(b).quadrature->size(); ++q) {
        const MaskOf<T> defined = known & this->template move_to<1>(b, q, states);
        FieldJet<Euclidean<3>, 1, T> m;
        m.d[0] = this->batches().template reference<1>(b, q).tangent[0];
        const BodyStrains<1, T> e = body_strains(m, std::get<1>(states).interpolation.jet());
        require_along(e.v[0], defined, b, q);
        for (std::size_t i = 0; i < 3; ++i) {
          this->parameter(b, q, strains_begin + i) = e.v[0].e[i];
          this->parameter(b, q, strains_begin + 3 + i) = e.u[0].e[i];
        }
      }
    }
  }
  std::vector<double> stress_free(int field) const override {
    return field == this->fields()[1] ? start_.values[static_cast<std::size_t>(field)] : std::vector<double>();
  }

 private:
  /// The stiffnesses are those of directors of which the third is along the rod, one way or the other.
  void require_along(const Vec3<T>& v, const MaskOf<T>& defined, int b, int q) const {
    for (int lane = 0; lane < native_width; ++lane) {
      const Vec3<T>& x = this->batches().point(b, q).x;
      const auto at = [&] {
        return fmt::format("({:.6g}, {:.6g}, {:.6g})", karcher::lane(x[0], lane), karcher::lane(x[1], lane), karcher::lane(x[2], lane));
      };
      if (!karcher::lane(select(defined, T(1.0), T(0.0)), lane))
        throw InputError(fmt::format("The initial rotations around {} are too far apart to have a mean.", at()));
      const double along = std::fabs(karcher::lane(v[2], lane));
      if (along < 0.5)
        throw InputError(fmt::format("The third director of the initial rotation must be along the rod, but at {} they enclose {:.0f} degrees.", at(),
                                     std::acos(along) * 180 / std::numbers::pi));
    }
  }

  Configuration start_;
};

std::unique_ptr<Term> make_rod(const EnergyInfo& info, const TermInput& given) {
  TermInput input = given;
  input.quadrature_degree.try_emplace(CellKind::line, 2 * std::max(input.field(0).space->order(), input.field(1).space->order()) + 1);
  const auto section = input.choices.find("section");
  if (section != input.choices.end() && section->second != "given") add_stiffnesses(input, section->second);
  std::vector<std::string> keys;
  for (const char* name : {"A", "K", "v0", "u0"})
    for (int i = 0; i < 3; ++i) {
      keys.push_back(fmt::format("{}[{}]", name, i));
      input.parameters.try_emplace(keys.back(), 0.0);
    }
  return with_rule<Rotation, 1>(
      input.field(1), [&]<class I>() -> std::unique_ptr<Term> { return std::make_unique<RodTerm<I>>(term_info(info, input), input, keys); });
}

}  // namespace

std::vector<Entry> cosserat_rod_entries() {
  EnergyInfo e;
  e.type = "cosserat-rod";
  e.description =
      "Special Cosserat rod that bends, twists, stretches and shears (Antman; Simo 1985; Sander 2010). v = R^T m', u = axl(R^T R'), per reference "
      "length:\n"
      "W = 1/2 sum A_i (v_i - v0_i)^2 + 1/2 sum K_i (u_i - u0_i)^2\n"
      "The third director is along the rod. v0, u0 are the strains of the reference position and of the initial rotation: the rod is free of stress "
      "where it "
      "starts, straight or curved.\n"
      "A section gives A = [k_s G A, k_s G A, E A], K = [E I_1, E I_2, k_t G (I_1 + I_2)] with the second moments about d1 and d2.\n"
      "Default quadrature: degree 2 k + 1, k the higher of the two field orders.";
  e.dimensions = {1};
  e.fields = {{.key = "deformation", .manifolds = {&manifold_ops<Euclidean<3>>()}, .description = "position of the centre line", .moves = true},
              {.key = "rotation",
               .manifolds = {&manifold_ops<Rotation>()},
               .description = "rotation of the section; its columns are the directors, the third along the rod; initially free of stress"}};
  const Condition given{"section", {"given"}}, known{"section", {"rectangle", "circle", "tube"}}, rectangle{"section", {"rectangle"}},
      round{"section", {"circle", "tube"}}, tube{"section", {"tube"}};
  const auto positive = [](const char* name, const char* unit, const char* description, const Condition& only, std::optional<double> standard = {}) {
    return Parameter{
        .name = name, .unit = unit, .description = description, .default_value = standard, .minimum = 0, .minimum_allowed = false, .only = only};
  };
  e.parameters = {
      positive("A", "force", "stiffnesses against shear along d1 and d2, and stretch", given),
      positive("K", "force*length^2", "stiffnesses against bending about d1 and d2, and twist", given),
      positive("young", "force/length^2", "Young's modulus E", known),
      {.name = "poisson",
       .unit = "1",
       .description = "Poisson's ratio; G = E/(2(1 + poisson))",
       .default_value = {},
       .minimum = -1,
       .minimum_allowed = false,
       .only = known},
      positive("shear_correction", "1", "k_s", known, 5.0 / 6),
      positive("torsion_correction", "1", "k_t, for sections that warp: 0.843 for a square, 4 (h/w)^2 for a thin strip", known, 1.0),
      positive("width", "length", "size of the section along d1", rectangle),
      positive("height", "length", "size of the section along d2", rectangle),
      positive("radius", "length", "of the section, outside", round),
      positive("wall", "length", "thickness of the wall of a tube, at most its radius", tube),
  };
  e.parameters[0].size = e.parameters[1].size = 3;
  e.choices = {{"section", {"given", "rectangle", "circle", "tube"}, "cross-section that gives A and K; given: they are given themselves"}};
  e.parts = {"shear", "stretch", "bending", "twist"};
  e.stress_free = true;
  return {{e, &make_rod}};
}

}  // namespace karcher::catalogue
