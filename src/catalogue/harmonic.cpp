#include "karcher/energy/harmonic.hpp"

#include "catalogue/of_manifolds.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<Term> harmonic_term(const EnergyInfo& info, const TermInput& input);

}  // namespace karcher::catalogue

#ifdef KARCHER_MANIFOLD

#include "catalogue/density_terms.hpp"
#include "catalogue/sphere_harmonic_term.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<Term> harmonic_term(const EnergyInfo& info, const TermInput& input) {
  return with_dimension<1, 2, 3>(input, [&]<int D>() {
    return with_rules<D, M>(input, [&]<class I>() -> std::unique_ptr<Term> {
      constexpr VaryingDensity<Harmonic> model;
      if constexpr (requires { requires std::is_same_v<I, SphereProjection<M, D, NativeScalar>>; })
        return std::make_unique<SphereHarmonicTerm<M, D>>(term_info(info, input), input, model, parameter_keys(info, input));
      else
        return std::make_unique<DensityTerm<VaryingDensity<Harmonic>, D, I>>(term_info(info, input), input, model, parameter_keys(info, input));
    });
  });
}
template std::unique_ptr<Term> harmonic_term<KARCHER_MANIFOLD>(const EnergyInfo&, const TermInput&);

}  // namespace karcher::catalogue

#else

namespace karcher::catalogue {

std::vector<Entry> harmonic_entries() {
  EnergyInfo info;
  info.type = "harmonic";
  info.description = "Harmonic maps: 1/2 |grad u|^2 in the metric of the manifold (SO3: |axl(Q^T dQ)|^2; SPD: affine-invariant; H: curvature -1).";
  info.dimensions = {1, 2, 3};
  info.fields = {{"field", accepted(EveryManifold{}), "the map"}};
  info.parameters = {{"scale", "1", "factor; 2 gives int |grad u|^2", 1.0, 0.0, false}};
  return {{info, [](const EnergyInfo& entry, const TermInput& input) {
             return of_manifolds(EveryManifold{}, input, [&]<class M>() { return harmonic_term<M>(entry, input); });
           }}};
}

}  // namespace karcher::catalogue

#endif
