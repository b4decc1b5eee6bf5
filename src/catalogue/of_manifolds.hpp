#pragma once
/// \file
/// Entries for maps into any manifold. Their terms are compiled for one manifold at a time, so that the compilers work side by side: the part of the source under
/// KARCHER_MANIFOLD goes once into an object of its own for every manifold of EveryManifold, the other part into the object of the entry.

#include <memory>

#include "catalogue/entry.hpp"
#include "karcher/error.hpp"
#include "karcher/manifold/every_manifold.hpp"

namespace karcher::catalogue {

/// make<M>() for the manifold M of the term's first field, one of the list.
template <class... M, class Make>
std::unique_ptr<Term> of_manifolds(ManifoldList<M...>, const TermInput& input, const Make& make) {
  const Field& field = input.field(0);
  std::unique_ptr<Term> term;
  const auto attempt = [&]<class N>() {
    if (field.manifold == &manifold_ops<N>()) term = make.template operator()<N>();
  };
  (attempt.template operator()<M>(), ...);
  if (!term) throw InputError("Field \"" + field.name + "\" has values in " + field.manifold->name + ", for which this term is not defined.");
  return term;
}

}  // namespace karcher::catalogue
