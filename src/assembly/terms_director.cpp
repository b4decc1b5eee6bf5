#include "director_terms.hpp"
#include "karcher/energy/chiral_skyrmion.hpp"
#include "karcher/energy/frank_oseen.hpp"
#include "karcher/manifold/sphere.hpp"
#include "single_field_terms.hpp"

namespace karcher {

std::unique_ptr<Term> make_chiral_skyrmion_term(TermInput input) {
  return with_dimension<2>(input, [&]<int D>() {
    return with_rule<Sphere<2>, D>(input, [&]<class I>() -> std::unique_ptr<Term> {
      return std::make_unique<DensityTerm<ChiralSkyrmionModel, D, I>>("chiral-skyrmion", input, ChiralSkyrmionModel{},
                                                                      std::vector<std::string>{"kappa", "h"});
    });
  });
}

std::unique_ptr<Term> make_frank_oseen_term(TermInput input) {
  return with_dimension<2, 3>(input, [&]<int D>() {
    return with_rule<Sphere<2>, D>(input, [&]<class I>() -> std::unique_ptr<Term> {
      return std::make_unique<DensityTerm<FrankOseenModel, D, I>>("frank-oseen", input, FrankOseenModel{},
                                                                  std::vector<std::string>{"K1", "K2", "K3", "chi", "H[0]", "H[1]", "H[2]"});
    });
  });
}

}  // namespace karcher
