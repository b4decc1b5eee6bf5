#pragma once
/// \file
/// Terms of one field, by manifold: each is instantiated in the file of its manifolds (terms_<manifolds>.cpp), so that they compile apart.

#include <fmt/format.h>

#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/energy/dead_load.hpp"
#include "karcher/energy/harmonic.hpp"
#include "karcher/energy/l2_distance.hpp"
#include "karcher/error.hpp"
#include "sphere_harmonic_term.hpp"

namespace karcher {

/// with_rule for the first field of a term.
template <class M, int D, class Make>
std::unique_ptr<Term> with_rule(const TermInput& input, Make make) {
  return with_rule<M, D>(input.all_fields[static_cast<std::size_t>(input.fields.front())], make);
}

/// Calls make<D>() with the dimension of the region's entities, if it is one of those listed.
template <int... Ds, class Make>
std::unique_ptr<Term> with_dimension(const TermInput& input, Make make) {
  std::unique_ptr<Term> term;
  const auto attempt = [&]<int D>() {
    if (input.region.dim == D) term = make.template operator()<D>();
  };
  (attempt.template operator()<Ds>(), ...);
  if (!term)
    throw InputError(fmt::format("Region \"{}\" has dimension {}, for which this energy is not defined.", input.region.name, input.region.dim));
  return term;
}

inline std::vector<std::string> ambient_keys(const std::string& name, int ambient, std::vector<std::string> before = {}) {
  for (int c = 0; c < ambient; ++c) before.push_back(fmt::format("{}[{}]", name, c));
  return before;
}

template <class M>
std::unique_ptr<Term> make_harmonic_term(TermInput input) {
  return with_dimension<1, 2, 3>(input, [&]<int D>() {
    return with_rule<M, D>(input, [&]<class I>() -> std::unique_ptr<Term> {
      const std::vector<std::string> keys{"scale"};
      if constexpr (requires { requires std::is_same_v<I, SphereProjection<M, D, NativeScalar>>; })
        return std::make_unique<SphereHarmonicTerm<M, D>>("harmonic", input, HarmonicModel{}, keys);
      else
        return std::make_unique<DensityTerm<HarmonicModel, D, I>>("harmonic", input, HarmonicModel{}, keys);
    });
  });
}

template <class M>
std::unique_ptr<Term> make_l2_distance_term(TermInput input) {
  return with_rule<M, 0>(input, [&]<class I>() -> std::unique_ptr<Term> {
    return std::make_unique<DensityTerm<L2DistanceModel<M>, 0, I>>("l2-distance", input, L2DistanceModel<M>{},
                                                                   ambient_keys("target", M::ambient, {"weight"}));
  });
}

template <class M>
std::unique_ptr<Term> make_dead_load_term(const std::string& name, TermInput input) {
  return with_rule<M, 0>(input, [&]<class I>() -> std::unique_ptr<Term> {
    return std::make_unique<DensityTerm<DeadLoadModel<M>, 0, I>>(name, input, DeadLoadModel<M>{}, ambient_keys("value", M::ambient));
  });
}

}  // namespace karcher
