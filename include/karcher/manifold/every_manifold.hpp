#pragma once
/// \file
/// The manifolds that problem files know: a header and a line below. Names, descriptions, evaluators and the terms that are defined for every manifold follow.

#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/list.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/sphere.hpp"
#include "karcher/manifold/unitary.hpp"

namespace karcher {

// One a line, in the order in which they are told. CMake counts the lines: each becomes a source of its own (src/catalogue/one_manifold.cpp.in).
// clang-format off
using EveryManifold = ManifoldList<
    Euclidean<1>,
    Euclidean<2>,
    Euclidean<3>,
    Sphere<1>,
    Sphere<2>,
    Sphere<3>,
    Rotation,
    Unitary,
    Spd<2>,
    Spd<3>,
    Hyperbolic<2>,
    Hyperbolic<3>>;
// clang-format on

}  // namespace karcher
