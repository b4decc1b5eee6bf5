#include "karcher/io/output.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/fields.hpp"
#include "io/judge.hpp"
#include "karcher/catalogue/catalogue.hpp"
#include "karcher/io/vtu.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

using testing::field_on;
using testing::generated;
using testing::nodal;

const OutputArray& array(const std::vector<OutputArray>& arrays, const std::string& name) {
  for (const OutputArray& a : arrays)
    if (a.name == name) return a;
  throw std::runtime_error("no array " + name);
}

std::vector<std::string> names(const std::vector<OutputArray>& arrays) {
  std::vector<std::string> all;
  for (const OutputArray& a : arrays) all.push_back(a.name);
  return all;
}

double at(const OutputArray& a, std::size_t node, int component) {
  return a.values[node * static_cast<std::size_t>(a.components) + static_cast<std::size_t>(component)];
}

std::vector<double> rotation_about_e3(double angle) { return {std::cos(angle / 2), 0, 0, std::sin(angle / 2)}; }

TEST(Output, ADeformationMovesThePointsAndTellsTheDisplacement) {
  const auto mesh = generated("cylinder", {{"radius", {2}}, {"height", {1}}, {"cells", {5, 2}}, {"order", {2}}});
  const Field m = field_on(mesh, mesh->region("all"), "m", "R3", 1);
  const auto map = [](const Vec3<double>& x) { return std::vector<double>{3 * x[2] + 1, x[0], x[1] - x[2]}; };
  const OutputSampler output({.fields = {m}, .deformation = 0});
  const auto parts = output.sample({{nodal(m, map)}, 0});
  ASSERT_EQ(parts.size(), 1U);
  const OutputPart& part = parts[0];
  EXPECT_EQ(part.order, 2);  // of the geometry, though the field has order 1
  const auto &u = array(part.point_data, "displacement"), &x = array(part.point_data, "reference"), &value = array(part.point_data, "m");
  EXPECT_EQ(names(part.point_data), (std::vector<std::string>{"displacement", "reference", "m"}));
  for (std::size_t n = 0; n < part.points.size(); ++n) {
    EXPECT_NEAR(std::hypot(at(x, n, 0), at(x, n, 1)), 2, 1e-14);  // nodes of the mesh lie on the exact surface
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(part.points[n][i], at(value, n, i));
      EXPECT_NEAR(at(x, n, i) + at(u, n, i), part.points[n][i], 1e-15);
    }
  }
  // At the vertices, which are nodes of the field, the map itself; between them its interpolant of order 1.
  for (const OutputCell& c : part.cells) {
    const auto vertices = static_cast<std::size_t>(vertex_count(c.kind));
    for (std::size_t v = 0; v < vertices; ++v) {
      const auto n = static_cast<std::size_t>(c.nodes[v]);
      const auto expected = map({{at(x, n, 0), at(x, n, 1), at(x, n, 2)}});
      for (int i = 0; i < 3; ++i) EXPECT_EQ(part.points[n][i], expected[static_cast<std::size_t>(i)]);
    }
    for (std::size_t e = 0; e < vertices; ++e) {
      const auto mid = static_cast<std::size_t>(c.nodes[vertices + e]);
      const auto a = static_cast<std::size_t>(c.nodes[e]), b = static_cast<std::size_t>(c.nodes[(e + 1) % vertices]);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(part.points[mid][i], (part.points[a][i] + part.points[b][i]) / 2, 1e-15);
    }
  }
}

TEST(Output, APlaneDeformationStaysInItsPlane) {
  const auto mesh = generated("rectangle", {{"cells", {2, 2}}});
  const Field m = field_on(mesh, mesh->region("all"), "m", "R2", 1);
  const auto parts = OutputSampler({.fields = {m}, .deformation = 0})
                         .sample({{nodal(m,
                                         [](const Vec3<double>& x) {
                                           return std::vector<double>{2 * x[0], x[1]};
                                         })},
                                  0});
  for (std::size_t n = 0; n < parts[0].points.size(); ++n) {
    EXPECT_EQ(parts[0].points[n][2], 0);
    EXPECT_NEAR(at(array(parts[0].point_data, "displacement"), n, 0), parts[0].points[n][0] / 2, 1e-15);
  }
  EXPECT_EQ(array(parts[0].point_data, "m").components, 2);
}

TEST(Output, ADirectionOfLowerOrderIsInterpolatedByItsRule) {
  const auto mesh = generated("interval", {{"cells", {1}}});
  const auto direction = [](const Vec3<double>& x) {
    return x[0] < 0.5 ? std::vector<double>{1, 0, 0} : std::vector<double>{std::cos(1.2), std::sin(1.2), 0};
  };
  for (const Rule rule : {Rule::projection, Rule::geodesic}) {
    const Field n = field_on(mesh, mesh->region("all"), "n", "S2", 1, rule), u = field_on(mesh, mesh->region("all"), "u", "R1", 3);
    const auto parts = OutputSampler({.fields = {n, u}})
                           .sample({{nodal(n, direction), nodal(u, [](const Vec3<double>& x) { return std::vector<double>{x[0]}; })}, 0});
    EXPECT_EQ(parts[0].order, 3);
    const auto& value = array(parts[0].point_data, "n");
    for (std::size_t k = 0; k < 4; ++k) {
      const double s = parts[0].points[k][0];
      const double angle = rule == Rule::geodesic ? 1.2 * s : std::atan2(s * std::sin(1.2), 1 - s + s * std::cos(1.2));
      EXPECT_NEAR(at(value, k, 0), std::cos(angle), 1e-14);
      EXPECT_NEAR(at(value, k, 1), std::sin(angle), 1e-14);
    }
  }
}

TEST(Output, ARotationIsToldByItsQuaternionAndItsDirectors) {
  const auto mesh = generated("rectangle", {{"cells", {2, 1}}});
  const Field q = field_on(mesh, mesh->region("all"), "Q", "SO3", 2);
  const double angle = 0.7;
  const auto parts = OutputSampler({.fields = {q}}).sample({{nodal(q, [&](const Vec3<double>&) { return rotation_about_e3(angle); })}, 0});
  const auto& data = parts[0].point_data;
  EXPECT_EQ(names(data), (std::vector<std::string>{"director1", "director2", "director3", "normal", "Q"}));
  const double expected[3][3] = {{std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1}};
  for (std::size_t n = 0; n < parts[0].points.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(at(data[k], n, i), expected[k][i], 1e-15);
    EXPECT_EQ(at(data[4], n, 0), std::cos(angle / 2));
  }
}

TEST(Output, DirectorsAreTheColumnsOfTheRotationOfAnyQuaternion) {
  const auto mesh = generated("interval", {{"cells", {1}}});
  const Field q = field_on(mesh, mesh->region("all"), "Q", "SO3", 1);
  // Rotation by 120 degrees about (1, 1, 1): e1 -> e2 -> e3 -> e1.
  const auto parts = OutputSampler({.fields = {q}})
                         .sample({{nodal(q,
                                         [](const Vec3<double>&) {
                                           return std::vector<double>{0.5, 0.5, 0.5, 0.5};
                                         })},
                                  0});
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(at(parts[0].point_data[static_cast<std::size_t>(k)], 0, i), i == (k + 1) % 3 ? 1.0 : 0.0);
}

TEST(Output, TwoRotationsHaveDirectorsUnderTheirNames) {
  const auto mesh = generated("interval", {{"cells", {1}}});
  const Field p = field_on(mesh, mesh->region("all"), "P", "SO3", 1), q = field_on(mesh, mesh->region("all"), "Q", "SO3", 1);
  const auto identity = [](const Vec3<double>&) { return rotation_about_e3(0); };
  const auto parts = OutputSampler({.fields = {p, q}}).sample({{nodal(p, identity), nodal(q, identity)}, 0});
  EXPECT_EQ(names(parts[0].point_data),
            (std::vector<std::string>{"P.director1", "P.director2", "P.director3", "P", "Q.director1", "Q.director2", "Q.director3", "Q"}));
}

TEST(Output, ATensorIsWrittenRowByRow) {
  const auto mesh = generated("interval", {{"cells", {1}}});
  const Field p = field_on(mesh, mesh->region("all"), "P", "SPD3", 1);
  const ManifoldOps& ops = *p.manifold;
  const double matrix[9] = {2, 0.5, 0.25, 0.5, 3, -0.5, 0.25, -0.5, 4};
  std::vector<double> point(static_cast<std::size_t>(ops.ambient));
  ASSERT_TRUE(ops.make_point(matrix, point.data()));
  const auto parts = OutputSampler({.fields = {p}}).sample({{nodal(p, [&](const Vec3<double>&) { return point; })}, 0});
  const auto& value = array(parts[0].point_data, "P");
  ASSERT_EQ(value.components, 9);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(at(value, 1, i), matrix[i], 1e-15);
}

TEST(Output, WhereAnInterpolationIsNotDefinedThereIsNoNumber) {
  const auto mesh = generated("interval", {{"cells", {1}}});
  const Field n = field_on(mesh, mesh->region("all"), "n", "S2", 1), u = field_on(mesh, mesh->region("all"), "u", "R1", 2);
  const auto parts = OutputSampler({.fields = {n, u}}).sample({{{1, 0, 0, -1, 0, 0}, {0, 0, 0}}, 0});
  const auto& value = array(parts[0].point_data, "n");
  EXPECT_EQ(at(value, 0, 0), 1);
  EXPECT_EQ(at(value, 1, 0), -1);
  EXPECT_TRUE(std::isnan(at(value, 2, 0)));
}

TEST(Output, AFilmOnASolidIsAPartOfItsOwnThatMovesWithTheSolid) {
  const auto mesh = generated("box", {{"size", {2, 1, 1}}, {"cells", {2, 1, 1}}}, {{"shape", "hexahedron"}});
  const Region film = select(*mesh, "film", 2, true, [](const Vec3<double>& x) { return x[2] > 1 - 1e-9; });
  const Field q = field_on(mesh, film, "Q", "SO3", 2), m = field_on(mesh, mesh->region("all"), "m", "R3", 1);
  const auto stretch = [](const Vec3<double>& x) { return std::vector<double>{2 * x[0], x[1], 1.5 * x[2]}; };
  const auto parts = OutputSampler({.fields = {q, m}, .deformation = 1})
                         .sample({{nodal(q, [](const Vec3<double>&) { return rotation_about_e3(0); }), nodal(m, stretch)}, 0});
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].region, "all");
  EXPECT_EQ(parts[0].dim, 3);
  EXPECT_EQ(names(parts[0].point_data), (std::vector<std::string>{"displacement", "reference", "m"}));
  EXPECT_EQ(parts[1].region, "film");
  EXPECT_EQ(parts[1].dim, 2);
  EXPECT_EQ(parts[1].order, 2);
  EXPECT_EQ(parts[1].cells.size(), 2U);
  EXPECT_EQ(names(parts[1].point_data),
            (std::vector<std::string>{"director1", "director2", "director3", "normal", "Q", "displacement", "reference", "m"}));
  for (const auto& x : parts[1].points) EXPECT_NEAR(x[2], 1.5, 1e-15);

  const TemporaryDirectory directory;
  VtuSeries(directory.path()).write(0, 0.5, parts);
  const auto entries = judge({directory / "solution.pvd"})[0]["entries"];
  EXPECT_NEAR(entries[0]["vtu"]["measure"]["3"].get<double>(), 6, 1e-13);  // 4 x 1 x 1.5
  EXPECT_NEAR(entries[1]["vtu"]["measure"]["2"].get<double>(), 4, 1e-13);
  EXPECT_EQ(entries[1]["file"], "solution_0000.film.vtu");
}

TEST(Output, TheSameRegionUnderTwoNamesIsOnePart) {
  const auto mesh = generated("rectangle", {{"cells", {2, 1}}});
  const Region sheet = select(*mesh, "sheet", 2, false, [](const Vec3<double>&) { return true; });
  const Field m = field_on(mesh, mesh->region("all"), "m", "R1", 1), q = field_on(mesh, sheet, "n", "R1", 1);
  EXPECT_EQ(OutputSampler({.fields = {m, q}}).sample({{std::vector<double>(6), std::vector<double>(6)}, 0}).size(), 1U);
}

TEST(Output, AReferenceGivenByAFunctionIsWhatDisplacementsStartFrom) {
  const auto mesh = generated("rectangle", {{"size", {1, 2}}, {"cells", {4, 2}}});
  const Field m = field_on(mesh, mesh->region("all"), "m", "R3", 2);
  const auto roll = [](const Vec3<double>& x) { return Vec3<double>{{std::cos(x[0]), std::sin(x[0]), x[1]}}; };
  const auto rolled = [&](const Vec3<double>& x) {
    const Vec3<double> y = roll(x);
    return std::vector<double>{y[0], y[1], y[2]};
  };
  const auto parts = OutputSampler({.fields = {m}, .deformation = 0, .reference_position = roll}).sample({{nodal(m, rolled)}, 0});
  for (const double u : array(parts[0].point_data, "displacement").values) EXPECT_NEAR(u, 0, 1e-15);
  const auto& x = array(parts[0].point_data, "reference");
  for (std::size_t n = 0; n < parts[0].points.size(); ++n) EXPECT_NEAR(std::hypot(at(x, n, 0), at(x, n, 1)), 1, 1e-15);
}

/// A term with a known energy on every cell of a region, on the cells of one rank.
class KnownEnergies : public Term {
 public:
  KnownEnergies(std::string name, Region region, std::vector<int> cells, double value) : region_(std::move(region)), value_(value) {
    info_.name = std::move(name);
    info_.load = info_.name.ends_with("-load");
    if (value == 0.5) {
      info_.parts = {"even", "odd"};
      info_.quantities = {{"stress.N", "force/length", 2, "membrane forces"}, {"charge", "1", 1, "charge"}};
    }
    for (std::size_t begin = 0; begin < cells.size(); begin += native_width) {
      Batch b;
      b.cells_used = static_cast<int>(std::min<std::size_t>(native_width, cells.size() - begin));
      for (std::size_t lane = 0; lane < native_width; ++lane)
        b.cells[lane] = cells[begin + std::min<std::size_t>(lane, static_cast<std::size_t>(b.cells_used) - 1)];
      b.blocks = &blocks_;
      b.nodes.assign(native_width, 0);
      batches_.push_back(b);
    }
  }
  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return static_cast<int>(batches_.size()); }
  const Batch& batch(int b) const override { return batches_[static_cast<std::size_t>(b)]; }
  void evaluate(const Configuration&, int b, Want, BatchResult& out) const override {
    for (std::size_t lane = 0; lane < native_width; ++lane) {
      const int c = batch(b).cells[lane];
      out.energy[lane] = value_ * (1 + c);
      out.trouble[lane] = c == 3 ? Trouble::infinite_energy : Trouble::none;
    }
  }
  std::vector<std::array<double, native_width>> batch_quantities(const Configuration&, int b) const override {
    std::vector<std::array<double, native_width>> q(info_.quantities.empty() ? 0 : 3);
    for (std::size_t k = 0; k < q.size(); ++k)
      for (std::size_t lane = 0; lane < native_width; ++lane) q[k][lane] = 10.0 * batch(b).cells[lane] + static_cast<double>(k);
    return q;
  }
  std::vector<std::array<double, native_width>> batch_part_energies(const Configuration&, int b) const override {
    if (part_names().empty()) return {};
    std::vector<std::array<double, native_width>> parts(2);
    for (std::size_t lane = 0; lane < native_width; ++lane) {
      const int c = batch(b).cells[lane];
      parts[static_cast<std::size_t>(c % 2)][lane] = value_ * (1 + c);
    }
    return parts;
  }
  const Cell& cell(int c) const override { return region_.cells[static_cast<std::size_t>(c)]; }

 private:
  TermInfo info_;
  Region region_;
  double value_;
  std::vector<LocalBlock> blocks_{{0, 1}};
  std::vector<Batch> batches_;
};

TEST(Output, EnergyDensitiesAreEnergiesPerReferenceMeasureHoweverTheCellsAreShared) {
  const auto mesh = generated("rectangle", {{"size", {6, 1}}, {"cells", {3, 1}}}, {{"shape", "triangle"}});
  ASSERT_EQ(mesh->cells.size(), 6U);  // of area 1
  const Field u = field_on(mesh, mesh->region("all"), "u", "R1", 1);
  Region half = mesh->region("all");
  half.cells.resize(2);
  const Region edge = select(*mesh, "edge", 1, true, [](const Vec3<double>& x) { return x[0] < 1e-9; });
  const auto functional = [&](const std::vector<int>& all, const std::vector<int>& of_half, const std::vector<int>& of_edge) {
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(std::make_unique<KnownEnergies>("shell", mesh->region("all"), all, 0.5));
    terms.push_back(std::make_unique<KnownEnergies>("traction-load", edge, of_edge, 9.0));
    terms.push_back(std::make_unique<KnownEnergies>("film", half, of_half, -2.0));
    const std::vector<std::vector<char>> fixed{std::vector<char>(static_cast<std::size_t>(u.space->node_count()), 0)};
    const std::vector<Field> fields{u};
    return Functional(std::make_shared<const Layout>(std::span(fields), fixed, CellRanks(mesh->cells.size(), 0), 0, 1), std::move(terms));
  };
  OutputModel model{.fields = {u}};
  set_terms(model, functional({0}, {}, {}));
  EXPECT_EQ(model.terms, (std::vector<std::string>{"shell", "traction-load", "film"}));
  EXPECT_EQ(model.loads, (std::vector<std::string>{"traction-load"}));
  const OutputSampler output(model);
  const Configuration zero{{std::vector<double>(static_cast<std::size_t>(u.space->node_count()), 0.0)}, 0};
  const std::vector<double> whole = output.cell_energies(functional({0, 1, 2, 3, 4, 5}, {0, 1}, {0}), zero);
  std::vector<double> sum = output.cell_energies(functional({4, 0, 1}, {1}, {}), zero);
  const std::vector<double> other = output.cell_energies(functional({5, 3, 2}, {0}, {0}), zero);
  ASSERT_EQ(sum.size(), other.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];

  for (const auto& energies : {whole, sum}) {
    const OutputPart part = output.sample(zero, energies)[0];
    EXPECT_EQ(names(part.cell_data),
              (std::vector<std::string>{"energy_density.shell", "energy_density.shell.even", "energy_density.shell.odd", "stress.shell.N",
                                        "charge.shell", "energy_density.film"}));  // the load is on no cell of the part
    EXPECT_EQ(part.cell_data[3].components, 2);
    for (std::size_t c = 0; c < 6; ++c) {
      if (c == 3) {
        EXPECT_TRUE(std::isnan(part.cell_data[0].values[c]));
      } else {
        EXPECT_NEAR(part.cell_data[0].values[c], 0.5 * static_cast<double>(1 + c), 1e-14);
        EXPECT_EQ(part.cell_data[1 + c % 2].values[c], part.cell_data[0].values[c]);
        EXPECT_EQ(part.cell_data[2 - c % 2].values[c], 0);
      }
      // Quantities are not divided by the measure of the cell.
      for (std::size_t k = 0; k < 3 && c != 3; ++k)
        EXPECT_EQ(k < 2 ? part.cell_data[3].values[2 * c + k] : part.cell_data[4].values[c], 10.0 * static_cast<double>(c) + static_cast<double>(k));
      EXPECT_NEAR(part.cell_data[5].values[c], c < 2 ? -2.0 * static_cast<double>(1 + c) : 0.0, 1e-13);
    }
  }
  EXPECT_TRUE(output.sample(zero)[0].cell_data.empty());
}

TEST(Output, TheDensitiesOfAShellAndOfItsPartsAddUpToItsEnergy) {
  const auto mesh = generated("rectangle", {{"size", {2, 1}}, {"cells", {5, 3}}}, {{"shape", "triangle"}});
  TermInput input;
  input.mesh = mesh;
  input.region = mesh->region("all");
  input.all_fields = {field_on(mesh, input.region, "m", "R3", 2), field_on(mesh, input.region, "Q", "SO3", 1)};
  input.fields = {0, 1};
  input.parameters = {{"thickness", 0.3}, {"mu", 3.0}, {"lambda", 2.0}, {"mu_c", 1.5}, {"L_c", 0.2}, {"b[0]", 1.2}, {"b[1]", 0.7}, {"b[2]", 0.4}};
  input.choices = {{"coupling", "default"}};
  const std::vector<Field> fields = input.all_fields;
  // The sheet lies in its reference place, so that VTK integrates over the reference, but its rotations vary.
  const Configuration u{{nodal(fields[0],
                               [](const Vec3<double>& x) {
                                 return std::vector<double>{x[0], x[1], x[2]};
                               }),
                         nodal(fields[1], [](const Vec3<double>& x) { return rotation_about_e3(0.4 * x[0] - 0.3 * x[1] * x[1]); })},
                        0};
  std::vector<std::unique_ptr<Term>> terms;
  terms.push_back(make_term("cosserat-shell", input));
  const std::vector<std::vector<char>> fixed{std::vector<char>(static_cast<std::size_t>(3 * fields[0].space->node_count()), 0),
                                             std::vector<char>(static_cast<std::size_t>(3 * fields[1].space->node_count()), 0)};
  const Functional functional(std::make_shared<const Layout>(std::span(fields), fixed, CellRanks(mesh->cells.size(), 0), 0, 1), std::move(terms));
  OutputModel model{.fields = fields, .deformation = 0};
  set_terms(model, functional);
  const OutputSampler output(model);
  const TemporaryDirectory directory;
  write_vtu(directory / "shell.vtu", output.sample(u, output.cell_energies(functional, u))[0], 0);
  const auto integrals = judge({directory / "shell.vtu"})[0]["integrals"];

  const double energy = functional.energy(u).energy;
  ASSERT_GT(energy, 0.01);
  EXPECT_NEAR(integrals["energy_density.cosserat-shell"][0].get<double>(), energy, 1e-13 * energy);
  const std::vector<double> parts = functional.terms()[0]->part_energies(u);
  double sum = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double part = integrals["energy_density.cosserat-shell." + functional.terms()[0]->part_names()[k]][0].get<double>();
    EXPECT_NEAR(part, parts[k], 1e-13 * energy);
    sum += part;
  }
  EXPECT_NEAR(sum, energy, 1e-13 * energy);
}

TEST(Output, VtkIntegratesTheFieldsOfEveryKindOfCell) {
  const TemporaryDirectory directory;
  std::vector<std::filesystem::path> files;
  struct Case {
    std::string generator, shape;
    int dim;
  };
  const std::vector<Case> cases = {
      {"interval", "", 1}, {"rectangle", "triangle", 2}, {"rectangle", "quadrilateral", 2}, {"box", "tetrahedron", 3}, {"box", "hexahedron", 3}};
  for (const Case& c : cases)
    for (int p = 1; p <= 3; ++p) {
      const auto mesh = generated(c.generator, {{"cells", std::vector<double>(static_cast<std::size_t>(c.dim), 2)}},
                                  c.shape.empty() ? std::map<std::string, std::string>{} : std::map<std::string, std::string>{{"shape", c.shape}});
      const Field u = field_on(mesh, mesh->region("all"), "u", "R2", p);
      const auto polynomial = [&](const Vec3<double>& x) { return std::vector<double>{std::pow(x[0], p), 1 + std::pow(x[c.dim - 1], p) - 2 * x[0]}; };
      files.push_back(directory / (c.generator + c.shape + std::to_string(p) + ".vtu"));
      write_vtu(files.back(), OutputSampler({.fields = {u}}).sample({{nodal(u, polynomial)}, 0})[0], 0);
    }
  const auto facts = judge(files);
  for (std::size_t i = 0; i < files.size(); ++i) {  // on the unit interval, square and cube
    const auto p = static_cast<double>(i % 3 + 1);
    EXPECT_NEAR(facts[i]["integrals"]["u"][0].get<double>(), 1 / (p + 1), 1e-14) << files[i];
    EXPECT_NEAR(facts[i]["integrals"]["u"][1].get<double>(), 1 / (p + 1), 1e-14) << files[i];
  }
}

TEST(Output, TheNormalOfAShellIsThatOfItsReferenceTurned) {
  // A cylinder, whose normals point outwards, turned by Q = exp(0.7 [e_3]); its director d_3 = e_3 is tangent.
  const double angle = 0.7;
  const auto turned = [&](const Vec3<double>&) { return rotation_about_e3(angle); };
  for (const double order : {1.0, 2.0, 3.0}) {
    const auto mesh = generated("cylinder", {{"cells", {16, 4}}, {"order", {order}}});
    const Field q = field_on(mesh, mesh->region("all"), "Q", "SO3", static_cast<int>(order));
    const auto part = OutputSampler({.fields = {q}}).sample({{nodal(q, turned)}, 0})[0];
    const auto& normal = array(part.point_data, "normal");
    const double side = at(normal, 0, 0) * std::cos(angle) + at(normal, 0, 1) * std::sin(angle) < 0 ? -1 : 1;
    for (std::size_t n = 0; n < part.points.size(); ++n) {
      const double phi = std::atan2(part.points[n][1], part.points[n][0]) + angle;
      EXPECT_NEAR(side * at(normal, n, 0), std::cos(phi), order == 1 ? 0.2 : 2e-2);
      EXPECT_NEAR(side * at(normal, n, 1), std::sin(phi), order == 1 ? 0.2 : 2e-2);
      EXPECT_NEAR(std::hypot(at(normal, n, 0), at(normal, n, 1), at(normal, n, 2)), 1, 1e-14);
    }
    EXPECT_FALSE(normal.drawn);
    EXPECT_EQ(normal.component_names, (std::vector<std::string>{"x", "y", "z"}));
    EXPECT_EQ(array(part.point_data, "Q").component_names, (std::vector<std::string>{"w", "x", "y", "z"}));
  }
  // On a Moebius strip, which has one side, every normal has length 1 and is perpendicular to the strip all the same.
  const auto strip = generated("moebius", {{"cells", {24, 4}}, {"order", {3}}});
  const Field q = field_on(strip, strip->region("all"), "Q", "SO3", 1);
  const auto part = OutputSampler({.fields = {q}}).sample({{nodal(q, [](const Vec3<double>&) { return rotation_about_e3(0); })}, 0})[0];
  const auto& normal = array(part.point_data, "normal");
  for (std::size_t n = 0; n < part.points.size(); ++n) EXPECT_NEAR(std::hypot(at(normal, n, 0), at(normal, n, 1), at(normal, n, 2)), 1, 1e-14);
  // A solid and a curve have none.
  const auto box = generated("box", {{"cells", {1, 1, 1}}});
  const Field solid = field_on(box, box->region("all"), "Q", "SO3", 1);
  EXPECT_EQ(names(OutputSampler({.fields = {solid}}).sample({{nodal(solid, turned)}, 0})[0].point_data),
            (std::vector<std::string>{"director1", "director2", "director3", "Q"}));
}

}  // namespace
}  // namespace karcher
