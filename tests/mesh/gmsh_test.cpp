#include "karcher/mesh/gmsh.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "karcher/error.hpp"
#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/refine.hpp"
#include "mesh/contains.hpp"
#include "mesh/measure.hpp"
#include "mesh/msh_writer.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

const std::string data = KARCHER_SOURCE_DIR "/tests/mesh/data/";

/// A file that disappears with its name.
class File {
 public:
  explicit File(const std::string& content)
      : path_(::testing::TempDir() + "karcher_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".msh") {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~File() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string refusal(const std::string& content) {
  const File file(content);
  try {
    read_gmsh(file.path());
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_EQ(what.find(file.path()), 0u) << "the message must begin with the file: " << what;
    return what.substr(std::min(what.size(), file.path().size()));
  }
  return "no error";
}

/// Same nodes, same cells node by node, same regions, up to the numbering of the nodes.
void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.dim, b.dim);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  ASSERT_EQ(a.cells.size(), b.cells.size());
  const auto places = [](const Mesh& mesh, const std::vector<Cell>& cells) {
    std::vector<std::vector<std::array<double, 3>>> all;
    for (const Cell& c : cells) {
      auto& nodes = all.emplace_back();
      for (int n : c.nodes) nodes.push_back(mesh.nodes[static_cast<std::size_t>(n)].e);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(places(a, a.cells), places(b, b.cells));
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (const auto& [name, region] : a.regions) {
    EXPECT_EQ(region.dim, b.region(name).dim);
    EXPECT_EQ(region.name, name);
    EXPECT_EQ(places(a, region.cells), places(b, b.region(name).cells)) << name;
  }
}

std::vector<Mesh> samples(int order) {
  const std::vector<double> p = {static_cast<double>(order)};
  std::vector<Mesh> meshes;
  meshes.push_back(generate({"interval", {{"cells", {3}}, {"order", p}}, {}}));
  for (const char* shape : {"triangle", "quadrilateral"}) {
    meshes.push_back(generate({"cylinder", {{"cells", {5, 2}}, {"order", p}}, {{"shape", shape}}}));
    meshes.push_back(generate({"rectangle", {{"cells", {2, 3}}, {"order", p}}, {{"shape", shape}}}));
  }
  for (const char* shape : {"tetrahedron", "hexahedron"})
    meshes.push_back(generate({"box", {{"cells", {2, 1, 2}}, {"order", p}}, {{"shape", shape}}}));
  return meshes;
}

TEST(Gmsh, ReadsBackEveryCellKindAndOrderInAllFourFormats) {
  for (int order = 1; order <= 3; ++order)
    for (Mesh& mesh : samples(order)) {
      std::map<std::string, int> tags;
      for (const auto& entry : mesh.regions)
        if (entry.first != "all") tags[entry.first] = static_cast<int>(tags.size()) + 3;  // each facet is in two groups: its own and "boundary"
      for (int version : {2, 4})
        for (bool binary : {false, true}) {
          SCOPED_TRACE(std::string(name(mesh.cells[0].kind)) + " order " + std::to_string(order) + " MSH " + std::to_string(version) +
                       (binary ? " binary" : " ASCII"));
          const File file(MshWriter(version, binary).write(mesh, tags));
          expect_same(read_gmsh(file.path()), mesh);
        }
    }
}

TEST(Gmsh, ReadsMixedKindsInOneMesh) {
  Mesh mesh;
  mesh.dim = 2;
  mesh.nodes = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}, {{2, 0, 0}}};
  mesh.cells = {{CellKind::quadrilateral, 1, {0, 1, 2, 3}, {}}, {CellKind::triangle, 1, {1, 4, 2}, {}}};
  mesh.regions["all"] = {"all", 2, mesh.cells};
  mesh.regions["corner"] = {"corner", 2, {mesh.cells[1]}};
  for (int version : {2, 4})
    for (bool binary : {false, true}) {
      const File file(MshWriter(version, binary).write(mesh, {{"corner", 9}}));
      const Mesh read = read_gmsh(file.path());
      expect_same(read, mesh);
      EXPECT_NEAR(measure(read), 1.5, 1e-14);
    }
}

TEST(Gmsh, ReadsFilesOfGmshItselfWithTheirGroups) {
  // A box of 1 x 1 x 2 (data/solid.geo); "solid" and "again" are its volume, "floor" z = 0, "ends" z = 0 and z = 2, "edge" an edge of length 1; the
  // group of the point has no name.
  for (const char* file :
       {"tetrahedra_order2_msh41.msh", "tetrahedra_order3_msh22.msh", "hexahedra_order2_msh22_binary.msh", "hexahedra_order3_msh41_binary.msh"}) {
    SCOPED_TRACE(file);
    const Mesh mesh = read_gmsh(data + file);
    const std::map<std::string, std::pair<int, double>> expected = {{"all", {3, 2}},  {"solid", {3, 2}}, {"again", {3, 2}},  {"floor", {2, 1}},
                                                                    {"ends", {2, 2}}, {"edge", {1, 1}},  {"point-7", {0, 1}}};
    EXPECT_EQ(mesh.regions.size(), expected.size());
    for (const auto& [name, e] : expected) {
      EXPECT_EQ(mesh.region(name).dim, e.first) << name;
      EXPECT_NEAR(measure(mesh, mesh.region(name).cells), e.second, 1e-11) << name;
    }
    // Cells are straight, so every node must be where the Lagrange node of its number is: the order of the nodes is understood.
    for (const auto& entry : mesh.regions)
      for (const Cell& c : entry.second.cells)
        for (std::size_t i = 0; i < c.nodes.size(); ++i) {
          const Shape corner = lagrange(c.kind, 1, lagrange_nodes(c.kind, c.order)[i]);
          Vec3<double> x;
          for (std::size_t v = 0; v < corner.value.size(); ++v) x += corner.value[v] * mesh.nodes[static_cast<std::size_t>(c.nodes[v])];
          EXPECT_LT(norm2(x - mesh.nodes[static_cast<std::size_t>(c.nodes[i])]), 1e-20);  // Gmsh itself places nodes to 1e-12
        }
  }
}

TEST(Gmsh, ReadsCurvedCellsAndTheSameNameInTwoDimensions) {
  for (const char* file : {"disc_triangles_order3_msh22_binary.msh", "disc_quadrilaterals_order3_msh41.msh"}) {
    const Mesh mesh = read_gmsh(data + file);
    EXPECT_NEAR(measure(mesh, mesh.region("rim").cells), std::numbers::pi, 4e-4);  // eight cubic arcs
    EXPECT_NEAR(measure(mesh, mesh.region("rim:1").cells), 2 * std::numbers::pi, 4e-4);
    EXPECT_EQ(boundary_facets(mesh).size(), mesh.region("rim:1").cells.size());
  }
}

TEST(Gmsh, ReadsMeshesWithoutGroups) {
  const Mesh mesh = read_gmsh(data + "tetrahedra_untagged_msh41_binary.msh");
  EXPECT_NEAR(measure(mesh), 2, 1e-14);
  EXPECT_EQ(mesh.regions.size(), 1u);
}

TEST(Gmsh, LeavesOutNodesThatNoCellUses) {
  const File file(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 9 9 9\n3 1 0 0\n4 0 1 0\n5 7 7 7\n$EndNodes\n$Elements\n1\n1 2 0 1 3 "
      "4\n$EndElements\n");
  const Mesh mesh = read_gmsh(file.path());
  EXPECT_EQ(mesh.nodes.size(), 3u);
  EXPECT_NEAR(measure(mesh), 0.5, 1e-14);
}

std::string ascii(const std::string& nodes, const std::string& cells) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + cells + "$EndElements\n";
}
const std::string three_nodes = "3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n";

TEST(Gmsh, RefusesSerendipityCellsAndOtherTypesByName) {
  try {
    read_gmsh(data + "serendipity_msh41.msh");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_TRUE(contains(e.what(), "serendipity_msh41.msh:142, section $Elements: cells of type 16, a quadrilateral of 8 nodes (serendipity"));
  }
  EXPECT_TRUE(contains(refusal(ascii("6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 0 1\n6 0 1 1\n", "1\n1 6 0 1 2 3 4 5 6\n")),
                       ":15, section $Elements: cells of type 6, a prism, are not read"));
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "1\n1 77 0 1 2 3\n")), "cells of type 77, are not read"));
}

TEST(Gmsh, RefusesMissingFilesAndOtherFiles) {
  try {
    read_gmsh("/no/such/mesh.msh");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()), "Cannot open the mesh file \"/no/such/mesh.msh\".");
  }
  EXPECT_TRUE(contains(refusal(""), "it is empty"));
  EXPECT_TRUE(contains(refusal("solid cube\n"), ":1: this is not a Gmsh mesh file"));
  EXPECT_TRUE(contains(refusal("$Nodes\n0\n$EndNodes\n"), "must begin with $MeshFormat"));
  EXPECT_TRUE(contains(refusal("$MeshFormat\n4 0 8\n$EndMeshFormat\n"), "MSH format 4.0; formats 2.2 and 4.1 are read"));
  EXPECT_TRUE(contains(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), "there is no section $Nodes"));
  EXPECT_TRUE(contains(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + three_nodes + "$EndNodes\n"), "there is no section $Elements"));
}

TEST(Gmsh, RefusesDamagedNumbersWithTheirLine) {
  EXPECT_TRUE(
      contains(refusal(ascii("3\n1 0 0 0\n2 1 zero 0\n3 0 1 0\n", "1\n1 2 0 1 2 3\n")), ":7, section $Nodes: a number is expected, not \"zero\""));
  EXPECT_TRUE(contains(refusal(ascii("3\n1 0 0 0\n2 1 nan 0\n3 0 1 0\n", "1\n1 2 0 1 2 3\n")), "node 2 are not finite"));
  EXPECT_TRUE(contains(refusal(ascii("3\n1 0 0 0\n1 1 0 0\n3 0 1 0\n", "1\n1 2 0 1 2 3\n")), "node 1 occurs twice"));
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "1\n5 2 0 1 2 4\n")), ":12, section $Elements: cell 5 uses node 4, which is not in the file"));
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "900\n1 2 0 1 2 3\n")), "truncated"));
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "1\n1 15 0 1\n")), "there are no cells in the file"));
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "2\n1 2 0 1 2 3\n2 2 0 3 2 1\n")), "the same triangle twice"));
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "1\n1 2 0 1 2 1\n")), "has the vertex at (0, 0, 0) twice"));
}

TEST(Gmsh, GroupsThatAreNoPartOfTheMeshAreNoRegions) {
  const File file(ascii("4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 5 5 5\n", "3\n1 2 0 1 2 3\n2 1 2 8 1 3 4\n3 1 2 9 1 1 2\n"));
  for (const Mesh& mesh : {read_gmsh(file.path()), refine(read_gmsh(file.path())).mesh}) {
    EXPECT_EQ(mesh.regions.size(), 2u);
    EXPECT_NEAR(measure(mesh, mesh.region("curve-9").cells), 1, 1e-14);
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_TRUE(contains(mesh.warnings[0], file.path() + ": the physical group \"curve-8\" has a line that is not part of any surface cell"));
    EXPECT_THROW(mesh.region("curve-8"), InputError);
  }
}

TEST(Gmsh, RefusesTruncatedFilesAtEveryLength) {
  const Mesh mesh = generate({"rectangle", {{"cells", {2, 2}}, {"order", {2}}}, {}});
  for (int version : {2, 4})
    for (bool binary : {false, true}) {
      const std::string whole = MshWriter(version, binary).write(mesh, {{"left", 1}});
      const std::size_t last = whole.rfind("$EndElements") + 12;
      for (std::size_t length = 0; length < last; length += 7) {
        const File file(whole.substr(0, length));
        EXPECT_THROW(read_gmsh(file.path()), InputError) << "MSH " << version << (binary ? " binary" : " ASCII") << " cut at " << length;
      }
    }
}

/// The same with the lines counted.
std::string msh22(const std::string& nodes, const std::string& cells) {
  const auto counted = [](const std::string& lines) { return std::to_string(std::count(lines.begin(), lines.end(), '\n')) + "\n" + lines; };
  return ascii(counted(nodes), counted(cells));
}

TEST(Gmsh, RefusesCellsThatAreFoldedOverThemselves) {
  // The middle of the long edge is pushed into the triangle, to (a, a): the determinant is 1 + (4 a - 2) (x + y), negative on that edge for a < 1/4. The same in
  // another plane, since nothing but the normal tells which side is up.
  for (const bool upright : {false, true}) {
    const auto triangle = [&](double a) {
      const std::string p = std::to_string(a);
      const auto node = [&](const std::string& x, const std::string& y) { return upright ? x + " 0 " + y + "\n" : x + " " + y + " 0\n"; };
      return msh22("1 " + node("0", "0") + "2 " + node("1", "0") + "3 " + node("0", "1") + "4 " + node("0.5", "0") + "5 " + node(p, p) + "6 " +
                       node("0", "0.5"),
                   "7 9 2 1 1 1 2 3 4 5 6\n");
    };
    EXPECT_EQ(refusal(triangle(0.26)), "no error");
    const std::string folded = refusal(triangle(0.24));
    EXPECT_TRUE(contains(folded, "triangle 7 is folded over itself at (")) << folded;
    EXPECT_TRUE(contains(folded, "area by reference area there is -0.04 and elsewhere up to 1.")) << folded;
    EXPECT_TRUE(contains(folded, "Mesh.HighOrderOptimize = 2")) << folded;
    EXPECT_TRUE(contains(refusal(triangle(0.1)), "triangle 7 is folded over itself at ("));  // it is 0 on a row of the points that are looked at
  }
  // A curve that turns back, a quadrilateral with a corner inside, a hexahedron with a corner pulled through.
  EXPECT_TRUE(contains(refusal(msh22("1 0 0 0\n2 1 0 0\n3 1.2 0 0\n", "1 8 2 1 1 1 2 3\n")), "line 1 is folded over itself at (1, 0, 0)"));
  EXPECT_TRUE(contains(refusal(msh22("1 0 0 0\n2 1 0 0\n3 0.3 0.3 0\n4 0 1 0\n", "4 3 2 1 1 1 2 3 4\n")),
                       "quadrilateral 4 is folded over itself at (0.3, 0.3, 0)"));
  const std::string cube = "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n8 0 1 1\n";
  EXPECT_TRUE(contains(refusal(msh22(cube + "7 0.2 0.2 0.2\n", "1 5 2 1 1 1 2 3 4 5 6 7 8\n")), "hexahedron 1 is folded over itself"));
  EXPECT_EQ(refusal(msh22(cube + "7 0.8 0.8 0.8\n", "1 5 2 1 1 1 2 3 4 5 6 7 8\n")), "no error");
}

TEST(Gmsh, ACellMayBendByMoreThanARightAngleAndHaveStraightCorners) {
  // Three quarters of a circle in one cubic line, half a cylinder in one quadrilateral; a corner of 180 degrees.
  EXPECT_EQ(refusal(msh22("1 1 0 0\n2 0 -1 0\n3 0 1 0\n4 -1 0 0\n", "1 26 2 1 1 1 2 3 4\n")), "no error");
  EXPECT_EQ(
      refusal(msh22("1 1 0 0\n2 -1 0 0\n3 -1 0 1\n4 1 0 1\n5 0 1 0\n6 -1 0 0.5\n7 0 1 1\n8 1 0 0.5\n9 0 1 0.5\n", "1 10 2 1 1 1 2 3 4 5 6 7 8 9\n")),
      "no error");
  EXPECT_EQ(refusal(msh22("1 0 0 0\n2 1 0 0\n3 0.5 0.5 0\n4 0 1 0\n", "1 3 2 1 1 1 2 3 4\n")), "no error");
  // Sides of a solid that the file lists the other way round are none the less solids.
  EXPECT_EQ(refusal(msh22("1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", "1 4 2 1 1 1 3 2 4\n")), "no error");
}

TEST(Gmsh, ReadsParametricNodesAndFilesWithAByteOrderMark) {
  // Behind the coordinates: dimension and tag of the model's entity, and as many parameters as curves and surfaces have.
  const std::string parametric =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 2 0.25\n3 1 1 0 2 3 0.5 0.5\n4 0 1 0 3 "
      "1\n$EndParametricNodes\n"
      "$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n";
  EXPECT_NEAR(measure(read_gmsh(File(parametric).path())), 1, 1e-14);
  EXPECT_NEAR(measure(read_gmsh(File("\xEF\xBB\xBF" + parametric).path())), 1, 1e-14);
  std::string binary = "$MeshFormat\n2.2 1 8\n";
  const auto put = [&](auto x) { binary.append(reinterpret_cast<const char*>(&x), sizeof x); };
  put(1);
  binary += "\n$EndMeshFormat\n$ParametricNodes\n4\n";
  for (const int node : {1, 2, 3, 4}) {
    put(node);
    for (const double x : {node == 2 || node == 3 ? 1.0 : 0.0, node > 2 ? 1.0 : 0.0, 0.0}) put(x);
    for (const int i : {node - 1, 7}) put(i);
    for (int k = 0; k < node - 1 && node < 4; ++k) put(0.5);
  }
  binary += "\n$EndParametricNodes\n$Elements\n1\n";
  for (const int i : {3, 1, 2, 5, 1, 1, 1, 2, 3, 4}) put(i);
  EXPECT_NEAR(measure(read_gmsh(File(binary + "\n$EndElements\n").path())), 1, 1e-14);
  EXPECT_TRUE(contains(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n1\n1 0 0 0 4 1\n$EndParametricNodes\n"),
                       ":6, section $ParametricNodes: node 1 lies on an entity of dimension 4."));
}

TEST(Gmsh, FilesOfOtherProgramsAreRefusedWithTheCommandThatConvertsThem) {
  const TemporaryDirectory directory;
  const auto told = [&](const std::string& name, const std::string& content = "other\n") {
    std::ofstream(directory / name) << content;
    try {
      read_gmsh((directory / name).string());
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_TRUE(contains(told("part.step"), "gmsh -2 -order 2 -format msh41 -o part.msh part.step"));
  EXPECT_TRUE(contains(told("part.UNV"), "gmsh -save -format msh41 -o part.msh part.UNV"));
  EXPECT_TRUE(contains(told("part.vtu"), "meshio convert --output-format gmsh part.vtu part.msh"));
  EXPECT_TRUE(contains(told("part.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n"), "gmsh -save -format msh41 -o part-41.msh part.msh"));
  EXPECT_TRUE(contains(told("part.msh", "$NOD\n0\n$ENDNOD\n"), "gmsh -save -format msh41 -o part-41.msh part.msh"));
}

TEST(Gmsh, RefusesDirectoriesDevicesAndPipesAtOnce) {
  const TemporaryDirectory directory;
  const auto told = [&](const std::string& name) {
    try {
      read_gmsh(name);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_TRUE(contains(told(directory.path().string()), "is a directory."));
  EXPECT_TRUE(contains(told("/dev/zero"), "is no file but a device or a pipe."));
  ASSERT_EQ(mkfifo((directory / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(contains(told((directory / "pipe").string()), "is no file but a device or a pipe."));
}

TEST(Gmsh, NodesOfGreatNumbersTakeNoMoreMemoryThanOthers) {
  const auto peak = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1000;  // MB
  };
  const auto before = peak();
  for (const std::string tag : {"67108000", "2000000000"}) {
    const File file(ascii("3\n1 0 0 0\n2 1 0 0\n" + tag + " 0 1 0\n", "1\n1 2 2 0 1 1 2 " + tag + "\n"));
    EXPECT_EQ(read_gmsh(file.path()).nodes.size(), 3u);
  }
  EXPECT_LT(peak() - before, 100);
}

TEST(Gmsh, RefusesAMeshFileThatDoesNotFitIntoMemoryBeforeItIsRead) {
  const TemporaryDirectory directory;
  const std::string file = (directory / "hole.msh").string();
  std::ofstream(file) << "$MeshFormat\n";
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40);
  try {
    read_gmsh(file);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& e) {
    EXPECT_TRUE(contains(e.what(), "hole.msh\" needs at least about 2.2 TB of memory; this process may have ")) << e.what();
  }
}

TEST(Gmsh, RefusesNamesThatAreNotUtf8) {
  EXPECT_TRUE(contains(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"W\xe4nde\"\n$EndPhysicalNames\n"), "is not UTF-8."));
}

TEST(Gmsh, RefusesAPhysicalTagThatHasNoAbsoluteValue) {
  EXPECT_TRUE(contains(refusal(ascii(three_nodes, "1\n1 2 2 -2147483648 1 1 2 3\n")), "the physical tag -2147483648 is out of range."));
}

}  // namespace
}  // namespace karcher
