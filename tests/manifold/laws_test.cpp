#include <gtest/gtest.h>

#include "karcher/manifold/euclidean.hpp"
#include "karcher/manifold/hyperbolic.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/manifold/rotation.hpp"
#include "karcher/manifold/spd.hpp"
#include "karcher/manifold/unitary.hpp"
#include "karcher/testing/manifold_laws.hpp"

using namespace karcher;

KARCHER_MANIFOLD_LAWS(R1, Euclidean<1>)
KARCHER_MANIFOLD_LAWS(R2, Euclidean<2>)
KARCHER_MANIFOLD_LAWS(R3, Euclidean<3>)
KARCHER_MANIFOLD_LAWS(S1, Sphere<1>)
KARCHER_MANIFOLD_LAWS(S2, Sphere<2>)
KARCHER_MANIFOLD_LAWS(S3, Sphere<3>)
KARCHER_MANIFOLD_LAWS(SO3, Rotation)
KARCHER_MANIFOLD_LAWS(SU2, Unitary)
KARCHER_MANIFOLD_LAWS(SPD2, Spd<2>)
KARCHER_MANIFOLD_LAWS(SPD3, Spd<3>)
KARCHER_MANIFOLD_LAWS(H2, Hyperbolic<2>)
KARCHER_MANIFOLD_LAWS(H3, Hyperbolic<3>)
KARCHER_MANIFOLD_LAWS(ProductR3SO3, Product<Euclidean<3>, Rotation>)
KARCHER_MANIFOLD_LAWS(ProductSPD2S2, Product<Spd<2>, Sphere<2>>)
