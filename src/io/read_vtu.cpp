#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <pugixml.hpp>
#include <string_view>

#include "io/base64.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/vtu.hpp"

namespace karcher {
namespace {

template <class T>
std::vector<T> numbers(const pugi::xml_node& array, std::string_view type) {
  if (array.attribute("type").value() != type || array.attribute("format").value() != std::string_view("binary"))
    throw InputError(fmt::format("its array \"{}\" is not {} in binary", array.attribute("Name").value(), type));
  const std::string bytes = read_compressed(array.text().get());
  if (bytes.size() % sizeof(T) != 0) throw InputError(fmt::format("its array \"{}\" ends within a number", array.attribute("Name").value()));
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

pugi::xml_node array_of(const pugi::xml_node& node, const char* name) { return node.find_child_by_attribute("DataArray", "Name", name); }

std::vector<OutputArray> arrays(const pugi::xml_node& node, std::size_t tuples) {
  std::vector<OutputArray> out;
  for (const pugi::xml_node& array : node.children("DataArray")) {
    OutputArray a{array.attribute("Name").value(), array.attribute("NumberOfComponents").as_int(), numbers<double>(array, "Float64")};
    if (a.components < 1 || a.values.size() != tuples * static_cast<std::size_t>(a.components))
      throw InputError(fmt::format("its array \"{}\" has {} numbers for {} places", a.name, a.values.size(), tuples));
    out.push_back(std::move(a));
  }
  return out;
}

/// The kind and order of a cell of this type with so many nodes; false if there is none.
bool find_cell(int type, std::size_t nodes, CellKind& kind, int& order) {
  for (const CellKind k :
       {CellKind::vertex, CellKind::line, CellKind::triangle, CellKind::quadrilateral, CellKind::tetrahedron, CellKind::hexahedron})
    for (int p = 1; p <= 3; ++p)
      if (vtk_cell_type(k) == type && lagrange_nodes(k, p).size() == nodes) {
        kind = k;
        order = p;
        return true;
      }
  return false;
}

void read_cells(const pugi::xml_node& node, OutputPart& part) {
  const auto connectivity = numbers<std::int64_t>(array_of(node, "connectivity"), "Int64");
  const auto offsets = numbers<std::int64_t>(array_of(node, "offsets"), "Int64");
  const auto types = numbers<std::uint8_t>(array_of(node, "types"), "UInt8");
  if (types.size() != offsets.size()) throw InputError("its cells have not one type each");
  std::int64_t begin = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    const std::int64_t end = offsets[c];
    if (end < begin || end > static_cast<std::int64_t>(connectivity.size())) throw InputError("its cells have nodes that are not there");
    OutputCell cell;
    int order = 1;
    if (!find_cell(types[c], static_cast<std::size_t>(end - begin), cell.kind, order))
      throw InputError(fmt::format("its cell {} is not one of Karcher's", c));
    // Vertices are of every order.
    if (cell.kind != CellKind::vertex && part.dim > 0 && order != part.order) throw InputError("its cells are not of one order");
    if (cell.kind != CellKind::vertex) part.order = order;
    part.dim = std::max(part.dim, dimension(cell.kind));
    const std::vector<int>& places = vtk_node_order(cell.kind, part.order);
    cell.nodes.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int64_t n = connectivity[static_cast<std::size_t>(begin) + i];
      if (n < 0 || n >= static_cast<std::int64_t>(part.points.size())) throw InputError("its cells have nodes that are not there");
      cell.nodes[static_cast<std::size_t>(places[i])] = static_cast<int>(n);
    }
    part.cells.push_back(std::move(cell));
    begin = end;
  }
}

OutputPart read(const std::string& content) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(content.data(), content.size());
  if (!parsed) throw InputError(fmt::format("it is no XML ({}, at byte {})", parsed.description(), parsed.offset));
  const pugi::xml_node root = document.child("VTKFile"), piece = root.child("UnstructuredGrid").child("Piece");
  if (!piece || root.attribute("header_type").value() != std::string_view("UInt64") ||
      root.attribute("compressor").value() != std::string_view("vtkZLibDataCompressor"))
    throw InputError("it is no compressed unstructured grid of VTK");
  OutputPart part;
  const auto points = numbers<double>(array_of(piece.child("Points"), "Points"), "Float64");
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) part.points.push_back({{points[i], points[i + 1], points[i + 2]}});
  read_cells(piece.child("Cells"), part);
  part.point_data = arrays(piece.child("PointData"), part.points.size());
  part.cell_data = arrays(piece.child("CellData"), part.cells.size());
  return part;
}

}  // namespace

OutputPart read_vtu(const std::filesystem::path& file) {
  const std::string content = read_whole(file);
  try {
    return read(content);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{} was not written by Karcher: {}.", file.string(), e.what()));
  }
}

}  // namespace karcher
