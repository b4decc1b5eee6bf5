#pragma once
/// \file
/// Terms of a density on the generic kernel, compiled for the manifolds, dimensions and interpolation rules that an entry names.

#include <fmt/format.h>

#include <memory>

#include "catalogue/entry.hpp"
#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/with_rule.hpp"
#include "karcher/error.hpp"

namespace karcher::catalogue {

/// make<D>() with the dimension of the region's entities, one of those listed.
template <int... Ds, class Make>
std::unique_ptr<Term> with_dimension(const TermInput& input, const Make& make) {
  std::unique_ptr<Term> term;
  const auto attempt = [&]<int D>() {
    if (input.region.dim == D) term = make.template operator()<D>();
  };
  (attempt.template operator()<Ds>(), ...);
  if (!term)
    throw InputError(fmt::format("Region \"{}\" has dimension {}, for which this energy is not defined.", input.region.name, input.region.dim));
  return term;
}

/// The term of Density<P> on fields with values in M, ..., on regions of the dimensions Ds.
template <template <class> class Density, class... M>
struct DensityTerms {
  template <int... Ds>
  static std::unique_ptr<Term> make(const EnergyInfo& info, const TermInput& input) {
    return with_dimension<Ds...>(input, [&]<int D>() {
      return with_rules<D, M...>(input, [&]<class... I>() -> std::unique_ptr<Term> {
        return std::make_unique<DensityTerm<VaryingDensity<Density>, D, I...>>(term_info(info, input), input, VaryingDensity<Density>{},
                                                                               parameter_keys(info, input));
      });
    });
  }
};

/// The term of a density that depends on the value alone, on regions of any dimension.
template <template <class> class Density, class M>
std::unique_ptr<Term> value_term(const EnergyInfo& info, const TermInput& input) {
  return with_rules<0, M>(input, [&]<class I>() -> std::unique_ptr<Term> {
    return std::make_unique<DensityTerm<VaryingDensity<Density>, 0, I>>(term_info(info, input), input, VaryingDensity<Density>{},
                                                                        parameter_keys(info, input));
  });
}

}  // namespace karcher::catalogue
