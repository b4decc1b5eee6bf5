#pragma once
/// \file
/// ManifoldList<M1, M2, ...>: some manifolds, to go through at compile time.

#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace karcher {

template <class... Ms>
struct ManifoldList {
  static constexpr int size = static_cast<int>(sizeof...(Ms));
  template <int I>
  using At = std::tuple_element_t<static_cast<std::size_t>(I), std::tuple<Ms...>>;
  template <class M>
  static constexpr bool has = (std::is_same_v<M, Ms> || ...);

  /// f<M>() for every M, in the order of the list.
  template <class F>
  static void for_each(F f) {
    (f.template operator()<Ms>(), ...);
  }
  static std::vector<std::string> names() { return {std::string(Ms::name)...}; }
};

}  // namespace karcher
