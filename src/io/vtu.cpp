#include "karcher/io/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

#include "io/base64.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/summary.hpp"

namespace karcher {
namespace {

static_assert(std::endian::native == std::endian::little, "files say byte_order=\"LittleEndian\"");

std::string escaped(std::string_view text) {
  std::string s;
  for (const char c : text) {
    switch (c) {
      case '&':
        s += "&amp;";
        break;
      case '<':
        s += "&lt;";
        break;
      case '>':
        s += "&gt;";
        break;
      case '"':
        s += "&quot;";
        break;
      default:
        s += c;
    }
  }
  return s;
}

template <class T>
constexpr std::string_view vtk_type = "Float64";
template <>
constexpr std::string_view vtk_type<std::int64_t> = "Int64";
template <>
constexpr std::string_view vtk_type<std::uint8_t> = "UInt8";

template <class T>
void append_array(std::string& out, std::string_view name, int components, std::span<const T> values, std::string_view more = "") {
  out += fmt::format("        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"binary\">", vtk_type<T>, escaped(name),
                     components, more);
  append_compressed(out, values.data(), values.size_bytes());
  out += "</DataArray>\n";
}

void append_data(std::string& out, std::string_view tag, const std::vector<OutputArray>& arrays) {
  out += fmt::format("      <{}>\n", tag);
  for (const OutputArray& a : arrays) {
    std::string names;
    for (std::size_t i = 0; i < a.component_names.size(); ++i) names += fmt::format(" ComponentName{}=\"{}\"", i, escaped(a.component_names[i]));
    append_array<double>(out, a.name, a.components, a.values, names);
  }
  out += fmt::format("      </{}>\n", tag);
}

/// Region names may hold anything; file names, and names in a collection, may not.
std::string file_name_of(std::string_view name) {
  std::string s;
  for (const char c : name) s += std::string_view("/\\:*?\"'<>&| \t\n").find(c) == std::string_view::npos ? c : '_';
  return s;
}

}  // namespace

void remove_state(const std::filesystem::path& directory, const VtuEntry& entry) {
  std::error_code ignored;
  if (std::filesystem::path(entry.file).filename() == entry.file && entry.file.ends_with(".vtu"))
    std::filesystem::remove(directory / entry.file, ignored);
}

void write_vtu(const std::filesystem::path& file, const OutputPart& part, double t) {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  for (const OutputCell& c : part.cells) {
    for (const int k : vtk_node_order(c.kind, part.order)) connectivity.push_back(c.nodes[static_cast<std::size_t>(k)]);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(static_cast<std::uint8_t>(vtk_cell_type(c.kind)));
  }
  std::vector<double> points;
  points.reserve(3 * part.points.size());
  for (const Vec3<double>& x : part.points) points.insert(points.end(), {x[0], x[1], x[2]});

  // Version 1.0 is the lowest with 64-bit headers, and the highest that meshio reads; before 2.1 the nodes of hexahedra are in the order of vtk_cells.cpp.
  std::string s =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
      "  <UnstructuredGrid>\n    <FieldData>\n";
  append_array<double>(s, "TimeValue", 1, std::span(&t, 1), " NumberOfTuples=\"1\"");
  s += fmt::format("    </FieldData>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", part.points.size(), part.cells.size());
  append_data(s, "PointData", part.point_data);
  append_data(s, "CellData", part.cell_data);
  s += "      <Points>\n";
  append_array<double>(s, "Points", 3, points);
  s += "      </Points>\n      <Cells>\n";
  append_array<std::int64_t>(s, "connectivity", 1, connectivity);
  append_array<std::int64_t>(s, "offsets", 1, offsets);
  append_array<std::uint8_t>(s, "types", 1, types);
  s += "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
  write_atomically(file, s);
}

VtuSeries::VtuSeries(std::filesystem::path directory, const std::string& stem) : directory_(std::move(directory)), stem_(file_name_of(stem)) {}

void VtuSeries::resume(int first_state) {
  entries_.clear();
  const std::filesystem::path collection = directory_ / (stem_ + ".pvd");
  if (!std::filesystem::exists(collection)) return;
  entries_ = read_collection(collection);
  std::erase_if(entries_, [&](const VtuEntry& e) {
    if (e.state >= first_state) remove_state(directory_, e);
    return e.state >= first_state || !std::filesystem::exists(directory_ / e.file);
  });
}

void VtuSeries::write(int state, double t, const std::vector<OutputPart>& parts) {
  std::erase_if(entries_, [&](const VtuEntry& e) { return e.state == state; });
  std::vector<std::string> names;
  for (const OutputPart& p : parts) names.push_back(file_name_of(p.region));
  names = distinct_names(std::move(names));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    VtuEntry e{state, static_cast<int>(i), t, names[i], fmt::format("{}_{:04}{}{}.vtu", stem_, state, i == 0 ? "" : ".", i == 0 ? "" : names[i])};
    write_vtu(directory_ / e.file, parts[i], t);
    entries_.push_back(std::move(e));
  }
  // `state` is ours, other readers skip it; fmt prints t so that it reads back to the same double.
  std::string s = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n";
  for (const VtuEntry& e : entries_)
    s += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" state=\"{}\" file=\"{}\"/>\n", e.t, e.part, e.region, e.state,
                     e.file);
  s += "  </Collection>\n</VTKFile>\n";
  write_atomically(directory_ / (stem_ + ".pvd"), s);
}

}  // namespace karcher
