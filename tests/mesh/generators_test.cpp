#include "karcher/mesh/generators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "karcher/error.hpp"
#include "mesh/measure.hpp"

namespace karcher {
namespace {

using std::numbers::pi;

TEST(Generators, FlatShapesHaveTheirMeasureForEveryShapeAndOrder) {
  for (double order : {1.0, 2.0, 3.0}) {
    EXPECT_NEAR(measure(generate({"interval", {{"length", {2.5}}, {"order", {order}}}, {{"axis", "y"}}})), 2.5, 1e-14);
    for (const char* shape : {"triangle", "quadrilateral"})
      EXPECT_NEAR(measure(generate({"rectangle", {{"lower", {-1, 2}}, {"size", {2, 3}}, {"cells", {3, 2}}, {"order", {order}}}, {{"shape", shape}}})),
                  6, 1e-13);
    for (const char* shape : {"tetrahedron", "hexahedron"})
      EXPECT_NEAR(measure(generate({"box", {{"size", {2, 3, 0.5}}, {"cells", {3, 2, 1}}, {"order", {order}}}, {{"shape", shape}}})), 3, 1e-13);
  }
}

TEST(Generators, ClosedSurfacesHaveTheirEulerCharacteristic) {
  EXPECT_EQ(euler_characteristic(generate({"sphere", {}, {}})), 2);
  EXPECT_EQ(euler_characteristic(generate({"torus", {}, {}})), 0);
  EXPECT_EQ(euler_characteristic(generate({"klein-bottle", {}, {}})), 0);
  EXPECT_EQ(euler_characteristic(generate({"moebius", {}, {}})), 0);
  EXPECT_EQ(euler_characteristic(generate({"disc", {}, {}})), 1);
  EXPECT_EQ(euler_characteristic(generate({"disc", {}, {{"shape", "quadrilateral"}}})), 1);
}

}  // namespace
}  // namespace karcher
