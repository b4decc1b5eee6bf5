#include "karcher/energy/l2_distance.hpp"

#include "catalogue/of_manifolds.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<Term> l2_distance_term(const EnergyInfo& info, const TermInput& input);

}  // namespace karcher::catalogue

#ifdef KARCHER_MANIFOLD

#include "catalogue/density_terms.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<Term> l2_distance_term(const EnergyInfo& info, const TermInput& input) {
  return value_term<L2DistanceTo<M>::template Density, M>(info, input);
}
template std::unique_ptr<Term> l2_distance_term<KARCHER_MANIFOLD>(const EnergyInfo&, const TermInput&);

}  // namespace karcher::catalogue

#else

namespace karcher::catalogue {

std::vector<Entry> l2_distance_entries() {
  EnergyInfo info;
  info.type = "l2-distance";
  info.description = "weight/2 dist(u, target)^2 with the Riemannian distance of the manifold.";
  info.dimensions = {0, 1, 2, 3};
  info.fields = {{"field", accepted(EveryManifold{}), "the map"}};
  info.parameters = {{"weight", "1", "factor", 1.0, 0.0},
                     {.name = "target",
                      .unit = "1",
                      .description = "target map, written like a field's initial value",
                      .default_value = {},
                      .size = Parameter::ambient,
                      .point = true}};
  return {{info, [](const EnergyInfo& entry, const TermInput& input) {
             return of_manifolds(EveryManifold{}, input, [&]<class M>() { return l2_distance_term<M>(entry, input); });
           }}};
}

}  // namespace karcher::catalogue

#endif
