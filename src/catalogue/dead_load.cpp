#include "karcher/energy/dead_load.hpp"

#include "catalogue/of_manifolds.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<Term> dead_load_term(const EnergyInfo& info, const TermInput& input);

}  // namespace karcher::catalogue

#ifdef KARCHER_MANIFOLD

#include "catalogue/density_terms.hpp"

namespace karcher::catalogue {

template <class M>
std::unique_ptr<Term> dead_load_term(const EnergyInfo& info, const TermInput& input) {
  if constexpr (LoadManifold::has<M>)
    return value_term<DeadLoadOn<M>::template Density, M>(info, input);
  else
    return nullptr;
}
template std::unique_ptr<Term> dead_load_term<KARCHER_MANIFOLD>(const EnergyInfo&, const TermInput&);

}  // namespace karcher::catalogue

#else

namespace karcher::catalogue {

std::vector<Entry> dead_load_entries() {
  std::vector<Entry> entries;
  const auto add = [&](const char* type, std::vector<int> dimensions, const char* unit, const char* description) {
    EnergyInfo info;
    info.type = type;
    info.load = true;
    info.description = description;
    info.dimensions = std::move(dimensions);
    info.fields = {{"field", accepted(LoadManifold{}), "the field on which the load works"}};
    info.parameters = {
        {.name = "value", .unit = unit, .description = "load in ambient coordinates of the field", .default_value = {}, .size = Parameter::ambient}};
    entries.push_back({info, [](const EnergyInfo& entry, const TermInput& input) {
                         return of_manifolds(LoadManifold{}, input, [&]<class M>() { return dead_load_term<M>(entry, input); });
                       }});
  };
  add("volume", {1, 2, 3}, "force/measure", "Dead load per reference volume (per area of a shell, per length of a rod): - int f.u");
  add("traction", {0, 1, 2}, "force/measure", "Dead load per reference area of a boundary region (per length of a shell's edge): - int f.u");
  add("line", {1}, "force/length", "Dead load per reference length: - int f.u");
  add("point", {0}, "force", "Dead load at every node of the region: - sum f.u");
  return entries;
}

}  // namespace karcher::catalogue

#endif
