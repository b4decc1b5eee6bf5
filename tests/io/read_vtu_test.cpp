#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/vtu.hpp"
#include "temporary_directory.hpp"

namespace karcher {
namespace {

/// Two cells of the kind that share their nodes, with numbers that a text would round.
OutputPart part_of(CellKind kind, int order) {
  OutputPart part;
  part.dim = dimension(kind);
  part.order = order;
  const auto& nodes = lagrange_nodes(kind, order);
  OutputCell cell{kind, {}}, reversed{kind, {}};
  OutputArray u{"u", 2, {}, {"first", "second"}}, energy{"energy_density.e", 1, {0.1, 1e-300}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    part.points.push_back(std::sqrt(2.0) * nodes[i]);
    cell.nodes.push_back(static_cast<int>(i));
    u.values.insert(u.values.end(), {1 / (3.0 + static_cast<double>(i)), std::nan("")});
  }
  reversed.nodes.assign(cell.nodes.rbegin(), cell.nodes.rend());
  part.cells = {cell, reversed};
  part.point_data = {u};
  part.cell_data = {energy};
  return part;
}

TEST(ReadVtu, GivesWhatWasWrittenBitForBitForEveryCell) {
  const TemporaryDirectory directory;
  for (const CellKind kind : {CellKind::line, CellKind::triangle, CellKind::quadrilateral, CellKind::tetrahedron, CellKind::hexahedron})
    for (int order = 1; order <= 3; ++order) {
      const OutputPart written = part_of(kind, order);
      write_vtu(directory / "part.vtu", written, 0.5);
      const OutputPart read = read_vtu(directory / "part.vtu");
      EXPECT_EQ(read.dim, written.dim);
      EXPECT_EQ(read.order, order);
      ASSERT_EQ(read.points.size(), written.points.size());
      for (std::size_t n = 0; n < read.points.size(); ++n) EXPECT_EQ(read.points[n].e, written.points[n].e);
      ASSERT_EQ(read.cells.size(), 2u);
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_EQ(read.cells[c].kind, kind);
        EXPECT_EQ(read.cells[c].nodes, written.cells[c].nodes);
      }
      ASSERT_EQ(read.point_data.size(), 1u);
      EXPECT_EQ(read.point_data[0].name, "u");
      ASSERT_EQ(read.point_data[0].components, 2);
      for (std::size_t i = 0; i < written.point_data[0].values.size(); i += 2) {
        EXPECT_EQ(read.point_data[0].values[i], written.point_data[0].values[i]);
        EXPECT_TRUE(std::isnan(read.point_data[0].values[i + 1]));
      }
      EXPECT_EQ(read.cell_data.at(0).values, written.cell_data[0].values);
    }
}

TEST(ReadVtu, TakesArraysOfManyBlocks) {
  const TemporaryDirectory directory;
  OutputPart part = part_of(CellKind::line, 1);
  OutputArray large{"large", 40000, {}};
  for (int i = 0; i < 80000; ++i) large.values.push_back(std::sin(i));
  part.point_data.push_back(large);
  write_vtu(directory / "part.vtu", part, 0);
  EXPECT_EQ(read_vtu(directory / "part.vtu").point_data[1].values, large.values);
}

TEST(ReadVtu, RefusesWhatIsDamagedOrNotOurs) {
  const TemporaryDirectory directory;
  write_vtu(directory / "part.vtu", part_of(CellKind::triangle, 2), 0);
  const std::string good = read_whole(directory / "part.vtu");
  const auto refusal = [&](const std::string& text) {
    std::ofstream(directory / "bad.vtu") << text;
    try {
      read_vtu(directory / "bad.vtu");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("taken");
  };
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(what), what.size(), instead);
    return refusal(text);
  };
  EXPECT_NE(refusal("").find("it is no XML"), std::string::npos);
  EXPECT_NE(refusal(good.substr(0, good.size() / 2)).find("it is no XML"), std::string::npos);
  EXPECT_NE(with("UInt64", "UInt32").find("it is no compressed unstructured grid"), std::string::npos);
  EXPECT_NE(with("Name=\"types\"", "Name=\"kinds\"").find("is not UInt8 in binary"), std::string::npos);
  EXPECT_NE(with("NumberOfComponents=\"2\"", "NumberOfComponents=\"3\"").find("its array \"u\" has 12 numbers for 6 places"), std::string::npos);
  const std::size_t data = good.find("format=\"binary\">", good.find("Name=\"connectivity\"")) + 16;
  std::string damaged = good;
  damaged[data + 60] = damaged[data + 60] == 'A' ? 'B' : 'A';
  EXPECT_NE(refusal(damaged).find("its compressed data are damaged"), std::string::npos);
  damaged = good;
  damaged[data] = '*';
  EXPECT_NE(refusal(damaged).find("its compressed data are damaged"), std::string::npos);
  damaged = good;
  damaged[data + 7] = '=';  // padding within a number
  EXPECT_NE(refusal(damaged).find("its compressed data are damaged"), std::string::npos);
  // A header that promises more than the data can hold must not cost the memory.
  damaged = good;
  damaged.replace(data, 8, "/////////");
  EXPECT_NE(refusal(damaged).find("its compressed data are damaged"), std::string::npos);
}

}  // namespace
}  // namespace karcher
