#include "karcher/io/vtu.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>

#include "io/judge.hpp"
#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/quadrature.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

const std::array<CellKind, 5> kinds = {CellKind::line, CellKind::triangle, CellKind::quadrilateral, CellKind::tetrahedron, CellKind::hexahedron};

double power(double x, int n) {
  double y = 1;
  for (int i = 0; i < n; ++i) y *= x;
  return y;
}

/// A polynomial map of total degree p of the reference cell to a place on the other side of (origin, 1, 1), without any symmetry, and its derivatives.
struct Bend {
  int p = 1, dim = 1;
  double origin = 0;
  std::array<double, 3> at(const Vec3<double>& xi) const {
    std::array<double, 3> x{origin + xi[0], 1 + xi[1], 1 + xi[2]};
    for (int i = 0; i < dim; ++i)
      for (int a = 0; a <= p; ++a)
        for (int b = 0; a + b <= p; ++b)
          for (int c = 0; a + b + c <= p; ++c)
            x[static_cast<std::size_t>(i)] += coefficient(i, a, b, c) * power(xi[0], a) * power(xi[1], b) * power(xi[2], c);
    return x;
  }
  double determinant(const Vec3<double>& xi) const {
    std::array<std::array<double, 3>, 3> j{};
    for (std::size_t i = 0; i < 3; ++i) j[i][i] = 1;
    for (int i = 0; i < dim; ++i)
      for (int a = 0; a <= p; ++a)
        for (int b = 0; a + b <= p; ++b)
          for (int c = 0; a + b + c <= p; ++c) {
            auto& row = j[static_cast<std::size_t>(i)];
            const double k = coefficient(i, a, b, c);
            if (a > 0) row[0] += k * a * power(xi[0], a - 1) * power(xi[1], b) * power(xi[2], c);
            if (b > 0 && dim > 1) row[1] += k * b * power(xi[0], a) * power(xi[1], b - 1) * power(xi[2], c);
            if (c > 0 && dim > 2) row[2] += k * c * power(xi[0], a) * power(xi[1], b) * power(xi[2], c - 1);
          }
    return j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) - j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
           j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
  }
  /// A field of the same degree.
  double field(const Vec3<double>& xi) const {
    return 0.3 + xi[0] - 2 * xi[1] + 0.7 * xi[2] + (p > 1 ? xi[0] * xi[1] - xi[1] * xi[2] * 0.4 : 0.0) +
           (p > 2 ? xi[0] * xi[0] * xi[1] + power(xi[2], 3) : 0.0);
  }

 private:
  static double coefficient(int i, int a, int b, int c) { return a + b + c == 0 ? 0 : 0.05 * std::sin(1.0 + 3 * i + 5 * a + 11 * b + 23 * c); }
};

/// Integral over the reference cell by a Gauss rule of degree 31 on the cube, collapsed onto simplices.
template <class F>
double integrate(CellKind kind, F f) {
  const Quadrature& line = quadrature(CellKind::line, 31);
  const int dim = dimension(kind), n = line.size();
  const bool simplex = kind == CellKind::triangle || kind == CellKind::tetrahedron;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < (dim > 1 ? n : 1); ++j)
      for (int k = 0; k < (dim > 2 ? n : 1); ++k) {
        Vec3<double> xi;
        double w = 1, shrink = 1;
        for (int a = 0; a < dim; ++a) {
          const auto q = static_cast<std::size_t>(a == 0 ? i : a == 1 ? j : k);
          xi[a] = line.points[q][0] * shrink;
          w *= line.weights[q] * shrink;
          if (simplex) shrink -= xi[a];
        }
        sum += w * f(xi);
      }
  return sum;
}

void append_cell(OutputPart& part, CellKind kind, const Bend& bend) {
  OutputCell cell{kind, {}};
  for (const Vec3<double>& xi : lagrange_nodes(kind, part.order)) {
    const auto x = bend.at(xi);
    cell.nodes.push_back(static_cast<int>(part.points.size()));
    part.points.push_back({{x[0], x[1], x[2]}});
    part.point_data[0].values.push_back(bend.field(xi));
  }
  part.cells.push_back(cell);
}

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

TEST(Vtu, VtkIntegratesOverEveryKindAndOrderOfCellWhatTheNodesSay) {
  const TemporaryDirectory directory;
  std::vector<std::filesystem::path> files;
  for (const CellKind kind : kinds)
    for (int p = 1; p <= 3; ++p) {
      OutputPart part{"all", dimension(kind), p, {}, {}, {{"u", 1, {}}}, {}};
      append_cell(part, kind, {p, dimension(kind), 0});
      files.push_back(directory / (std::string(name(kind)) + std::to_string(p) + ".vtu"));
      write_vtu(files.back(), part, 0);
    }
  const auto facts = judge(files);
  std::size_t f = 0;
  for (const CellKind kind : kinds)
    for (int p = 1; p <= 3; ++p, ++f) {
      SCOPED_TRACE(files[f].filename().string());
      const Bend bend{p, dimension(kind), 0};
      const std::string dim = std::to_string(dimension(kind)), type = std::to_string(vtk_cell_type(kind));
      EXPECT_EQ(facts[f]["cells"][type]["count"], 1);
      EXPECT_EQ(facts[f]["meshio"], nlohmann::json({{"points", node_count(kind, p)}, {"cells", 1}, {"arrays", {"u"}}, {"same", true}}));
      EXPECT_EQ(facts[f]["cells"][type]["nodes"], nlohmann::json({node_count(kind, p)}));
      const auto det = [&](const Vec3<double>& xi) { return std::abs(bend.determinant(xi)); };
      EXPECT_LT(relative(facts[f]["measure"][dim], integrate(kind, det)), 1e-12);
      EXPECT_LT(relative(facts[f]["moment"][dim], integrate(kind,
                                                            [&](const Vec3<double>& xi) {
                                                              const auto x = bend.at(xi);
                                                              return x[0] * x[0] * x[1] * x[2] * det(xi);
                                                            })),
                1e-12);
      EXPECT_LT(relative(facts[f]["integrals"]["u"][0], integrate(kind, [&](const Vec3<double>& xi) { return bend.field(xi) * det(xi); })), 1e-12);
    }
}

TEST(Vtu, TwoSwappedNodesAreNoticedByTheIntegrals) {
  const TemporaryDirectory directory;
  OutputPart part{"all", 3, 3, {}, {}, {{"u", 1, {}}}, {}};
  const Bend bend{3, 3, 0};
  append_cell(part, CellKind::hexahedron, bend);
  std::swap(part.cells[0].nodes[20], part.cells[0].nodes[21]);
  write_vtu(directory / "swapped.vtu", part, 0);
  const double exact = integrate(CellKind::hexahedron, [&](const Vec3<double>& xi) { return bend.determinant(xi); });
  EXPECT_GT(relative(judge({directory / "swapped.vtu"})[0]["measure"]["3"], exact), 1e-4);
}

TEST(Vtu, KindsOfCellsMayBeMixed) {
  const TemporaryDirectory directory;
  OutputPart part{"all", 2, 2, {}, {}, {{"u", 1, {}}}, {}};
  const Bend triangle{2, 2, 0}, quadrilateral{2, 2, 3};
  append_cell(part, CellKind::triangle, triangle);
  append_cell(part, CellKind::quadrilateral, quadrilateral);
  append_cell(part, CellKind::triangle, triangle);
  part.cell_data.push_back({"energy_density.harmonic", 1, {1, 10, 100}});
  write_vtu(directory / "mixed.vtu", part, 0);
  const auto facts = judge({directory / "mixed.vtu"})[0];
  EXPECT_EQ(facts["cells"]["69"]["count"], 2);
  EXPECT_EQ(facts["cells"]["70"]["count"], 1);
  const double t = integrate(CellKind::triangle, [&](const Vec3<double>& xi) { return triangle.determinant(xi); });
  const double q = integrate(CellKind::quadrilateral, [&](const Vec3<double>& xi) { return quadrilateral.determinant(xi); });
  EXPECT_LT(relative(facts["measure"]["2"], 2 * t + q), 1e-13);
  EXPECT_LT(relative(facts["integrals"]["energy_density.harmonic"][0], 101 * t + 10 * q), 1e-13);
}

TEST(Vtu, ASphereHasItsAreaWithTheOrderOfItsCells) {
  const TemporaryDirectory directory;
  std::vector<std::filesystem::path> files;
  for (const int order : {1, 2, 3})
    for (const int n : {2, 4}) {
      GeneratorOptions options;
      options.name = "sphere";
      options.numbers = {{"radius", {2.0}}, {"cells", {static_cast<double>(n)}}, {"order", {static_cast<double>(order)}}};
      const Mesh mesh = generate(options);
      OutputPart part{"all", 2, order, mesh.nodes, {}, {}, {}};
      for (const Cell& c : mesh.cells) part.cells.push_back({c.kind, c.nodes});
      files.push_back(directory / ("sphere" + std::to_string(order) + std::to_string(n) + ".vtu"));
      write_vtu(files.back(), part, 0);
    }
  const auto facts = judge(files);
  const double exact = 16 * std::numbers::pi;
  for (std::size_t i = 0; i < 3; ++i) {
    const double coarse = relative(facts[2 * i]["measure"]["2"], exact), fine = relative(facts[2 * i + 1]["measure"]["2"], exact);
    EXPECT_LT(fine, coarse / (i == 0 ? 3.5 : 12)) << "order " << i + 1;  // h^2, h^4, h^4
    EXPECT_LT(fine, i == 0 ? 0.02 : 1e-4) << "order " << i + 1;
  }
}

TEST(Vtu, EveryNumberArrivesBitForBit) {
  const TemporaryDirectory directory;
  OutputPart part{"all", 1, 1, {{{0, 0, 0}}, {{1, 0.1, -0.2}}}, {{CellKind::line, {0, 1}}}, {}, {}};
  part.point_data.push_back(
      {"u", 5, {0.1, -1.0 / 3, 5e-324, 1.7976931348623157e308, 1e-17, 6.02214076e23, -0.0, 3, 2.5e-308, std::nextafter(1.0, 2.0)}});
  write_vtu(directory / "exact.vtu", part, 0.1 + 0.2);
  const auto facts = judge({directory / "exact.vtu"}, true)[0];
  EXPECT_EQ(facts["values"]["u"].get<std::vector<double>>(), part.point_data[0].values);
  EXPECT_TRUE(std::signbit(facts["values"]["u"][6].get<double>()));
  EXPECT_EQ(facts["values"]["points"].get<std::vector<double>>(), (std::vector<double>{0, 0, 0, 1, 0.1, -0.2}));
  EXPECT_EQ(facts["time"], nlohmann::json({0.1 + 0.2}));
  EXPECT_EQ(facts["point_data"], nlohmann::json({{"u", 5}}));
}

/// n vertices as cells of their own, with one array.
OutputPart cloud(std::size_t n, std::vector<double> values) {
  OutputPart part{"all", 0, 1, std::vector<Vec3<double>>(n), {}, {{"u", static_cast<int>(values.size() / n), std::move(values)}}, {}};
  for (std::size_t i = 0; i < n; ++i) part.cells.push_back({CellKind::vertex, {static_cast<int>(i)}});
  return part;
}

TEST(Vtu, ArraysOfManyBlocksAreReadWhole) {
  const TemporaryDirectory directory;
  std::mt19937_64 random(7);
  std::vector<std::filesystem::path> files;
  std::vector<std::vector<double>> all;
  for (const std::size_t n : {2048U, 32768U, 65536U, 70001U}) {  // a part of a block, one whole block, two, two and a part
    std::vector<double> values(n);
    for (double& v : values) v = std::ldexp(static_cast<double>(random()), -64);
    all.push_back(values);
    files.push_back(directory / ("cloud" + std::to_string(n) + ".vtu"));
    write_vtu(files.back(), cloud(n, values), 0);
  }
  const auto facts = judge(files, true);
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_TRUE(facts[i]["values"]["u"].get<std::vector<double>>() == all[i]) << i;
}

TEST(Vtu, DataIsInlineBinaryAndCompressed) {
  const TemporaryDirectory directory;
  write_vtu(directory / "cloud.vtu", cloud(20000, std::vector<double>(60000, 1.25)), 0);
  const auto facts = judge({directory / "cloud.vtu"})[0];
  EXPECT_EQ(facts["compressor"], "vtkZLibDataCompressor");
  EXPECT_EQ(facts["formats"], nlohmann::json({"binary"}));
  EXPECT_EQ(facts["appended"], false);
  // 20000 points of 3 + 3 doubles, two 8-byte integers and a byte: 1.3 MB as they are.
  EXPECT_LT(std::filesystem::file_size(directory / "cloud.vtu"), 200000U);
}

TEST(Vtu, ANumberThatIsNoneDoesNotHurtTheOthers) {
  const TemporaryDirectory directory;
  write_vtu(directory / "nan.vtu", cloud(2, {std::numeric_limits<double>::quiet_NaN(), 2.5}), 0);
  EXPECT_EQ(judge({directory / "nan.vtu"}, true)[0]["values"]["u"], nlohmann::json({nullptr, 2.5}));
}

TEST(Vtu, NamesMayHoldAnyCharacter) {
  const TemporaryDirectory directory;
  OutputPart part = cloud(1, {1.0});
  part.point_data[0].name = "<u & \"v\">";
  write_vtu(directory / "names.vtu", part, 0);
  EXPECT_EQ(judge({directory / "names.vtu"})[0]["point_data"], nlohmann::json({{"<u & \"v\">", 1}}));
}

TEST(VtuSeries, TheCollectionTellsTheTimeOfEveryPart) {
  const TemporaryDirectory directory;
  VtuSeries series(directory.path());
  OutputPart film = cloud(2, {1, 2});
  film.region = "the film";
  const std::vector<double> times = {0, 0.1 + 0.2, 1.0 / 3};
  for (std::size_t i = 0; i < times.size(); ++i) series.write(static_cast<int>(i), times[i], {cloud(1, {static_cast<double>(i)}), film});
  const auto entries = judge({directory / "solution.pvd"}, true)[0]["entries"];
  ASSERT_EQ(entries.size(), 6U);
  for (std::size_t i = 0; i < times.size(); ++i)
    for (std::size_t part = 0; part < 2; ++part) {
      const auto& e = entries[2 * i + part];
      EXPECT_EQ(e["timestep"].get<double>(), times[i]);
      EXPECT_EQ(e["part"], part);
      EXPECT_EQ(e["name"], part == 0 ? "all" : "the_film");
      EXPECT_EQ(e["vtu"]["time"][0].get<double>(), times[i]);
      EXPECT_EQ(e["vtu"]["values"]["u"], part == 0 ? nlohmann::json({static_cast<double>(i)}) : nlohmann::json({1.0, 2.0}));
    }
  EXPECT_EQ(entries[1]["file"], "solution_0000.the_film.vtu");
  const std::vector<VtuEntry> read = read_collection(directory / "solution.pvd");
  ASSERT_EQ(read.size(), 6U);
  EXPECT_EQ(read[3].state, 1);
  EXPECT_EQ(read[3].part, 1);
  EXPECT_EQ(read[3].t, times[1]);
  EXPECT_EQ(read[3].region, "the_film");
  EXPECT_EQ(read[3].file, "solution_0001.the_film.vtu");
}

TEST(VtuSeries, AResumedRunContinuesTheCollection) {
  const TemporaryDirectory directory;
  {
    VtuSeries series(directory.path());
    for (int i = 0; i < 4; ++i) series.write(i, 0.25 * i, {cloud(1, {static_cast<double>(i)})});
  }
  VtuSeries series(directory.path());
  series.resume(2);
  series.write(2, 0.6, {cloud(1, {7.0})});
  const auto entries = judge({directory / "solution.pvd"}, true)[0]["entries"];
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[1]["timestep"], 0.25);
  EXPECT_EQ(entries[2]["timestep"], 0.6);
  EXPECT_EQ(entries[2]["vtu"]["values"]["u"], nlohmann::json({7.0}));
}

TEST(VtuSeries, AForeignCollectionIsNotContinued) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "solution.pvd") << "<VTKFile>\n<Collection>\n<DataSet timestep=\"0\" file=\"a.vtu\"/>\n</Collection>\n</VTKFile>\n";
  VtuSeries series(directory.path());
  EXPECT_THROW(series.resume(1), InputError);
}

TEST(VtuSeries, AMissingDirectoryIsAnErrorOfTheSystemWithTheName) {
  VtuSeries series("/nonexistent/results");
  try {
    series.write(0, 0, {cloud(1, {1.0})});
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("/nonexistent/results/solution_0000.vtu"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("No such file or directory"), std::string::npos);
  }
}

}  // namespace
}  // namespace karcher
