#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "io/base64.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/vtu.hpp"

namespace karcher {
namespace {

/// Value of an attribute in a line that we wrote; empty where it is missing.
std::string_view attribute(std::string_view line, std::string_view key) {
  const std::string start = fmt::format(" {}=\"", key);
  const std::size_t begin = line.find(start);
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin + start.size());
  return line.substr(0, line.find('"'));
}

template <class T>
bool parse(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

std::string unescaped(std::string_view text) {
  static constexpr std::pair<std::string_view, char> entities[] = {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}};
  std::string s;
  while (!text.empty()) {
    const auto entity = std::find_if(std::begin(entities), std::end(entities), [&](const auto& e) { return text.starts_with(e.first); });
    s += entity == std::end(entities) ? text.front() : entity->second;
    text.remove_prefix(entity == std::end(entities) ? 1 : entity->first.size());
  }
  return s;
}

std::string_view next_line(std::string_view& rest) {
  const std::string_view line = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  return line;
}

/// The numbers of a DataArray of this VTK type; nothing where the line is of another or damaged.
template <class T>
std::optional<std::vector<T>> numbers(std::string_view line, std::string_view type) {
  const std::size_t begin = line.find('>'), end = line.rfind('<');
  std::string bytes;
  if (attribute(line, "type") != type || begin == std::string_view::npos || end <= begin ||
      !read_compressed(line.substr(begin + 1, end - begin - 1), bytes) || bytes.size() % sizeof(T) != 0)
    return {};
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

constexpr CellKind all_kinds[] = {CellKind::vertex,        CellKind::line,        CellKind::triangle,
                                  CellKind::quadrilateral, CellKind::tetrahedron, CellKind::hexahedron};

/// Cells from VTK's description; false where it is no mesh of ours.
bool set_cells(OutputPart& part, const std::vector<std::int64_t>& connectivity, const std::vector<std::int64_t>& offsets,
               const std::vector<std::uint8_t>& types) {
  if (offsets.size() != types.size()) return false;
  std::size_t begin = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    const auto kind = std::find_if(std::begin(all_kinds), std::end(all_kinds), [&](CellKind k) { return vtk_cell_type(k) == types[c]; });
    const auto end = static_cast<std::size_t>(offsets[c]);
    if (kind == std::end(all_kinds) || end < begin || end > connectivity.size()) return false;
    int order = 1;
    while (order < 3 && node_count(*kind, order) != static_cast<int>(end - begin)) ++order;
    if (node_count(*kind, order) != static_cast<int>(end - begin)) return false;
    if (*kind != CellKind::vertex) part.order = order;
    part.dim = std::max(part.dim, dimension(*kind));
    OutputCell cell{*kind, std::vector<int>(end - begin)};
    for (std::size_t k = 0; k < cell.nodes.size(); ++k) {
      const std::int64_t node = connectivity[begin + k];
      if (node < 0 || static_cast<std::size_t>(node) >= part.points.size()) return false;
      cell.nodes[static_cast<std::size_t>(vtk_node_order(*kind, order)[k])] = static_cast<int>(node);
    }
    part.cells.push_back(std::move(cell));
    begin = end;
  }
  return begin == connectivity.size();
}

}  // namespace

OutputPart read_vtu(const std::filesystem::path& file) {
  const std::string content = read_whole(file);
  std::string_view rest = content;
  OutputPart part;
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::string_view section;
  bool good = true, ended = false;
  while (good && !rest.empty()) {
    const std::string_view line = next_line(rest);
    const std::string_view tag = line.substr(std::min(line.size(), line.find_first_not_of(' ')));
    for (const std::string_view s : {"<FieldData>", "<PointData>", "<CellData>", "<Points>", "<Cells>"})
      if (tag == s) section = s;
    ended = ended || tag == "</VTKFile>";
    if (!tag.starts_with("<DataArray")) continue;
    const std::string_view name = attribute(line, "Name");
    if (section == "<Cells>" && name == "types") {
      const auto values = numbers<std::uint8_t>(line, "UInt8");
      if ((good = values.has_value())) types = *values;
    } else if (section == "<Cells>") {
      const auto values = numbers<std::int64_t>(line, "Int64");
      if ((good = values.has_value())) (name == "offsets" ? offsets : connectivity) = *values;
    } else {
      auto values = numbers<double>(line, "Float64");
      int components = 0;
      good = values && parse(attribute(line, "NumberOfComponents"), components) && components > 0 &&
             values->size() % static_cast<std::size_t>(components) == 0;
      if (!good) break;
      if (section == "<PointData>") part.point_data.push_back({unescaped(name), components, std::move(*values)});
      if (section == "<CellData>") part.cell_data.push_back({unescaped(name), components, std::move(*values)});
      if (section == "<Points>")
        for (std::size_t i = 0; i + 2 < values->size(); i += 3) part.points.push_back({{(*values)[i], (*values)[i + 1], (*values)[i + 2]}});
    }
  }
  if (!good || !ended || !set_cells(part, connectivity, offsets, types))
    throw InputError(fmt::format("The file {} was not written by Karcher or is damaged.", file.string()));
  return part;
}

std::vector<VtuEntry> read_collection(const std::filesystem::path& file) {
  const std::string content = read_whole(file);
  std::string_view rest = content;
  std::vector<VtuEntry> entries;
  bool ended = false, good = true;
  while (!rest.empty()) {
    const std::string_view line = next_line(rest);
    ended = ended || line == "</VTKFile>";
    if (line.find("<DataSet") == std::string_view::npos) continue;
    VtuEntry e;
    e.region = attribute(line, "name");
    e.file = attribute(line, "file");
    good = good && parse(attribute(line, "timestep"), e.t) && parse(attribute(line, "part"), e.part) && parse(attribute(line, "state"), e.state) &&
           !e.file.empty();
    entries.push_back(std::move(e));
  }
  if (!good || !ended) throw InputError(fmt::format("The collection {} was not written by Karcher.", file.string()));
  std::stable_sort(entries.begin(), entries.end(),
                   [](const VtuEntry& a, const VtuEntry& b) { return std::pair(a.state, a.part) < std::pair(b.state, b.part); });
  return entries;
}

}  // namespace karcher
