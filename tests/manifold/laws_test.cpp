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

namespace {

/// The laws with all points at p: the identity, where many formulas have removable singularities.
template <class M>
void expect_laws_at(const Point<M>& p) {
  ManifoldLawOptions<M> options;
  options.samples = 20;
  options.point = [&](Random&) { return p; };
  for (const std::string& violated : manifold_laws<M>(options)) ADD_FAILURE() << violated;
}

}  // namespace

TEST(ManifoldLaws, HoldAtTheIdentity) {
  expect_laws_at<Sphere<1>>(Sphere<1>::origin());
  expect_laws_at<Sphere<2>>(Sphere<2>::origin());
  expect_laws_at<Sphere<3>>(Sphere<3>::origin());
  expect_laws_at<Rotation>(Rotation::origin());
  expect_laws_at<Unitary>(Unitary::origin());
  expect_laws_at<Spd<2>>(Spd<2>::origin());
  expect_laws_at<Spd<3>>(Spd<3>::origin());
  expect_laws_at<Hyperbolic<2>>(Hyperbolic<2>::origin());
  expect_laws_at<Hyperbolic<3>>(Hyperbolic<3>::origin());
  // south pole of the frame, and a half turn
  expect_laws_at<Sphere<2>>({{0, 0, -1}});
  expect_laws_at<Rotation>({{0, 0, 1, 0}});
}

TEST(ManifoldLaws, HoldAtMatricesWithEqualEigenvalues) {
  expect_laws_at<Spd<2>>({{3, 0, 0, 3}});
  expect_laws_at<Spd<3>>({{2, 0, 0, 0, 2, 0, 0, 0, 0.5}});
  // log at the identity of matrices with two equal eigenvalues, and nearly equal ones
  for (double gap : {0.0, 1e-12, 1e-6, 1e-3}) {
    ManifoldLawOptions<Spd<3>> options;
    options.samples = 20;
    bool first = false;
    options.point = [&](Random&) {
      first = !first;
      return first ? Spd<3>::origin() : Vec<double, 9>{{1.7, 0, 0, 0, 1.7 + gap, 0, 0, 0, 0.6}};
    };
    for (const std::string& violated : manifold_laws<Spd<3>>(options)) ADD_FAILURE() << violated << " (gap " << gap << ")";
  }
}
