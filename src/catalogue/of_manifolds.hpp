#pragma once
/// \file
/// Entries for maps into any manifold. Their terms are compiled for one manifold at a time, so that the compilers work side by side: the part of the source under
/// KARCHER_MANIFOLD goes once into an object of its own for every manifold of EveryManifold, the other part into the object of the entry.

#include <memory>

#include "catalogue/entry.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/every_manifold.hpp"

namespace karcher::catalogue {

/// make<M>() for the manifold M of the field, one of the list: a unique_ptr.
template <class M0, class... M, class Make>
auto of_manifolds(ManifoldList<M0, M...>, const Field& field, const Make& make) {
  decltype(make.template operator()<M0>()) made;
  const auto attempt = [&]<class N>() {
    if (field.manifold == &manifold_ops<N>()) made = make.template operator()<N>();
  };
  attempt.template operator()<M0>();
  (attempt.template operator()<M>(), ...);
  if (!made) throw InputError("Field \"" + field.name + "\" has values in " + field.manifold->name + ", for which this term is not defined.");
  return made;
}
/// Of the term's first field.
template <class List, class Make>
auto of_manifolds(List list, const TermInput& input, const Make& make) {
  return of_manifolds(list, input.field(0), make);
}

}  // namespace karcher::catalogue
