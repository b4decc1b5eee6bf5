#include "karcher/energy/frank_oseen.hpp"

#include "catalogue/density_terms.hpp"
#include "karcher/manifold/sphere.hpp"

namespace karcher::catalogue {

std::vector<Entry> frank_oseen_entries() {
  EnergyInfo info;
  info.type = "frank-oseen";
  info.description = "Nematic liquid crystal in a magnetic field H: 1/2 [K1 (div n)^2 + K2 (n.curl n)^2 + K3 |n x curl n|^2 - chi (n.H)^2].";
  info.dimensions = {2, 3};
  info.fields = {{.key = "field", .manifolds = {&manifold_ops<Sphere<2>>()}, .description = "director", .headless = true}};
  info.parameters = {{"K1", "force", "splay constant", {}, 0.0},
                     {"K2", "force", "twist constant", {}, 0.0},
                     {"K3", "force", "bend constant", {}, 0.0},
                     {"chi", "force/(length H)^2", "anisotropy of the susceptibility", 0.0},
                     {.name = "H", .unit = "H", .description = "magnetic field", .default_value = 0.0, .size = 3}};
  info.parts = {"splay", "twist", "bend", "magnetic"};
  return {{info, &DensityTerms<FrankOseen, Sphere<2>>::make<2, 3>}};
}

}  // namespace karcher::catalogue
