#pragma once
/// \file
/// From the rule that a field has at run time to the interpolation type that a kernel is compiled for.

#include <fmt/format.h>

#include <memory>
#include <tuple>
#include <type_traits>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"
#include "karcher/error.hpp"
#include "karcher/field/field.hpp"
#include "karcher/interpolation/rules.hpp"
#include "karcher/math/pack.hpp"

namespace karcher {

/// make<Interpolation>() with the interpolation of M-valued fields in D directions under the field's rule. \throws InputError for the projection rule on a
/// manifold that has no projection.
template <class M, int D, class Make>
auto with_rule(const Field& field, Make make) {
  if constexpr (is_linear<M>) {
    return make.template operator()<LinearInterpolation<M, D, NativeScalar>>();
  } else {
    if (field.rule == Rule::geodesic) return make.template operator()<GeodesicInterpolation<M, D, NativeScalar>>();
    if constexpr (HasProjection<M>)
      return make.template operator()<ProjectionInterpolation<M, D, NativeScalar>>();
    else
      throw InputError(
          fmt::format("Field \"{}\": {} has no projection from its ambient space; use interpolation = \"geodesic\".", field.name, M::name));
  }
}

/// make<I...>() with the interpolations of a term's fields, whose manifolds are M, ..., in the order of its slots.
template <int D, class... M, class... Known, class Make>
std::unique_ptr<Term> with_rules(const TermInput& input, const Make& make, std::type_identity<Known>... known) {
  constexpr std::size_t slot = sizeof...(Known);
  if constexpr (slot == sizeof...(M)) {
    return make.template operator()<Known...>();
  } else {
    return with_rule<std::tuple_element_t<slot, std::tuple<M...>>, D>(
        input.field(slot), [&]<class I>() { return with_rules<D, M...>(input, make, known..., std::type_identity<I>{}); });
  }
}

}  // namespace karcher
