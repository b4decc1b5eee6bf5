#include <gtest/gtest.h>

#include "karcher/manifold/every_manifold.hpp"
#include "karcher/manifold/product.hpp"
#include "karcher/testing/manifold_laws.hpp"

using namespace karcher;

namespace {

template <class M>
class EveryManifoldOfTheList : public ::testing::Test {};
template <class... Ms>
::testing::Types<Ms...> types_of(ManifoldList<Ms...>);
struct NameOfManifold {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};

}  // namespace

TYPED_TEST_SUITE(EveryManifoldOfTheList, decltype(types_of(EveryManifold{})), NameOfManifold);
TYPED_TEST(EveryManifoldOfTheList, ObeysTheLawsOfAManifold) {
  for (const std::string& violated : manifold_laws<TypeParam>()) ADD_FAILURE() << violated;
}
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
  EveryManifold::for_each([]<class M>() { expect_laws_at<M>(M::origin()); });
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
