#include "karcher/energy/chiral_skyrmion.hpp"

#include "catalogue/density_terms.hpp"
#include "karcher/manifold/sphere.hpp"

namespace karcher::catalogue {

std::vector<Entry> chiral_skyrmion_entries() {
  EnergyInfo info;
  info.type = "chiral-skyrmion";
  info.description = "Chiral magnet film (Melcher 2014): 1/2 |grad u|^2 + kappa u.curl u + h/2 |u - e3|^2, in units of the exchange length.";
  info.dimensions = {2};
  info.fields = {{"field", {&manifold_ops<Sphere<2>>()}, "magnetisation"}};
  info.parameters = {{"kappa", "1/length", "strength of the Dzyaloshinskii-Moriya interaction", {}}, {"h", "1/length^2", "field along e3", {}}};
  info.parts = {"exchange", "chiral", "zeeman"};
  return {{info, &DensityTerms<ChiralSkyrmion, Sphere<2>>::make<2>}};
}

}  // namespace karcher::catalogue
