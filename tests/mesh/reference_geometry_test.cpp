#include "karcher/mesh/reference_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "karcher/error.hpp"

namespace karcher {
namespace {

using Point3 = Vec3<double>;

GeometryJet spanned_by(const Point3& a, const Point3& b) {
  GeometryJet g;
  g.d[0] = a;
  g.d[1] = b;
  return g;
}

TEST(CellFrame, OfACellInThePlaneIsTheAxesWhicheverWayTheCellRuns) {
  const Point3 a{{2, 0.5, 0}}, b{{-0.3, 1.5, 0}};
  for (const GeometryJet& g : {spanned_by(a, b), spanned_by(b, a)}) {
    const CellFrame frame = cell_frame(g, 2);
    EXPECT_NEAR(frame.measure, 3.15, 1e-15);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(frame.t[0][i], i == 0, 1e-15);
      EXPECT_NEAR(frame.t[1][i], i == 1, 1e-15);
    }
  }
}

TEST(CellFrame, OfASurfaceIsOrthonormalAndTangentAndTurnsDerivativesInTheCellIntoThoseAlongIt) {
  const Point3 slope{{3, -5, 7}};  // of a linear function
  for (const auto& [a, b] : {std::pair{Point3{{2, 0.5, 0.3}}, Point3{{-0.3, 1.5, -1}}}, {Point3{{0, 1, 0.2}}, Point3{{0, 0.1, -2}}}}) {
    const CellFrame frame = cell_frame(spanned_by(a, b), 2);
    const Point3 normal = cross(a, b);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(dot(frame.t[i], normal), 0, 1e-14);
      for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(dot(frame.t[i], frame.t[j]), i == j, 1e-15);
      const int row = static_cast<int>(i);
      EXPECT_NEAR(frame.to_frame(row, 0) * dot(slope, a) + frame.to_frame(row, 1) * dot(slope, b), dot(slope, frame.t[i]), 1e-13);
    }
    EXPECT_GE(cross(frame.t[0], frame.t[1])[2], -1e-15);
    EXPECT_NEAR(frame.measure, std::sqrt(norm2(normal)), 1e-15);
  }
}

TEST(CellFrame, OfADegenerateCellIsRefusedWithThePlace) {
  GeometryJet flat = spanned_by({{1, 2, 0}}, {{2, 4, 0}});
  flat.x = {{0.5, 0.25, 3}};
  try {
    cell_frame(flat, 2);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("degenerate (its map has measure 0) at (0.5, 0.25, 3)"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace karcher
