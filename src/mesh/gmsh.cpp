#include "karcher/mesh/gmsh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "karcher/error.hpp"
#include "karcher/mesh/folds.hpp"
#include "karcher/mesh/node_key.hpp"
#include "karcher/mesh/periodic.hpp"
#include "mesh/gmsh_content.hpp"

namespace karcher {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Turns the content of a file into a mesh.
class Assembler {
 public:
  Assembler(std::string path, GmshContent content, PeriodicSides sides) : path_(std::move(path)), content_(std::move(content)), sides_(sides) {}

  Mesh assemble() {
    Mesh mesh;
    for (int dim = 1; dim <= 3; ++dim)
      if (!content_.layers[at(dim)].cells.empty()) mesh.dim = dim;
    if (mesh.dim == 0) throw InputError(path_ + ": there are no cells in the file, at most points.");
    if (content_.version == 2)
      for (GmshLayer& layer : content_.layers) join_repeated_cells(layer);
    for (int dim = 0; dim <= mesh.dim; ++dim) add_regions(mesh, dim, content_.layers[at(dim)]);
    mesh.cells = std::move(content_.layers[at(mesh.dim)].cells);
    const auto all = mesh.regions.find("all");
    if (all != mesh.regions.end() && (all->second.dim != mesh.dim || all->second.cells.size() != mesh.cells.size()))
      throw InputError(path_ + ": the physical name \"all\" is taken: it always means the whole mesh.");
    const std::vector<int> numbers = number_used_nodes(mesh);
    mesh.regions["all"] = {"all", mesh.dim, mesh.cells};
    try {
      check_identity(mesh);
    } catch (const InputError& e) {
      throw InputError(path_ + ": " + e.what());
    }
    refuse_folds(mesh);
    if (sides_ == PeriodicSides::joined) join_periodic(mesh, numbers);
    return mesh;
  }

 private:
  /// MSH 2.2 writes a cell again for every further group: one cell, the union of its groups.
  void join_repeated_cells(GmshLayer& layer) {
    NodeNumbering numbering(layer.cells.size());
    GmshLayer joined;
    for (std::size_t i = 0; i < layer.cells.size(); ++i) {
      const Cell& c = layer.cells[i];
      const auto found = numbering.insert(entity_key({c.nodes.data(), at(vertex_count(c.kind))}));
      const int group = layer.groups[i];
      if (found.inserted) {
        joined.cells.push_back(std::move(layer.cells[i]));
        joined.groups.push_back(group);
        joined.tags.push_back(layer.tags[i]);
        continue;
      }
      int& known = joined.groups[at(found.number)];
      std::vector<int> both = content_.groups.tags(known);
      for (int tag : content_.groups.tags(group)) {
        if (std::find(both.begin(), both.end(), tag) != both.end())
          throw InputError(path_ + ": the file has the same " + std::string(name(joined.cells[at(found.number)].kind)) + " twice.");
        both.push_back(tag);
      }
      if (content_.groups.tags(group).empty())
        throw InputError(path_ + ": the file has the same " + std::string(name(joined.cells[at(found.number)].kind)) + " twice.");
      known = content_.groups.number(std::move(both));
    }
    layer = std::move(joined);
  }

  std::string region_name(int dim, int tag, int top) const {
    const auto it = content_.names.find({dim, tag});
    if (it == content_.names.end() || it->second.empty()) {
      static constexpr std::array<const char*, 4> kinds = {"point", "curve", "surface", "volume"};
      return std::string(kinds[at(dim)]) + "-" + std::to_string(tag);
    }
    for (const auto& [other, other_name] : content_.names)
      if (other_name == it->second && other.first > dim && other.first <= top) return it->second + ":" + std::to_string(dim);
    return it->second;
  }

  void add_regions(Mesh& mesh, int dim, const GmshLayer& layer) const {
    std::vector<std::vector<Region*>> regions(at(content_.groups.count()));
    std::vector<char> used(regions.size(), 0);
    for (int g : layer.groups) used[at(g)] = 1;
    for (std::size_t g = 0; g < regions.size(); ++g) {
      if (!used[g]) continue;
      for (int tag : content_.groups.tags(static_cast<int>(g))) {
        const std::string region = region_name(dim, tag, mesh.dim);
        Region& r = mesh.regions[region];
        if (!r.name.empty() && r.dim != dim)
          throw InputError(path_ + ": the physical name \"" + region + "\" is used for groups of several dimensions.");
        r.name = region;
        r.dim = dim;
        if (std::find(regions[g].begin(), regions[g].end(), &r) == regions[g].end()) regions[g].push_back(&r);  // two groups may have one name
      }
    }
    for (std::size_t i = 0; i < layer.cells.size(); ++i)
      for (Region* r : regions[at(layer.groups[i])]) r->cells.push_back(layer.cells[i]);
  }

  /// Keeps the nodes that cells use, in the order of the file.
  std::vector<int> number_used_nodes(Mesh& mesh) const {
    std::vector<int> numbers(content_.nodes.size(), -1);
    for (const Cell& c : mesh.cells)
      for (int n : c.nodes) numbers[at(n)] = 0;
    for (std::size_t i = 0; i < content_.nodes.size(); ++i)
      if (numbers[i] == 0) {
        numbers[i] = static_cast<int>(mesh.nodes.size());
        mesh.nodes.push_back(content_.nodes[i]);
      }
    const auto renumber = [&](Cell& c) {
      for (int& n : c.nodes) n = numbers[at(n)];
      return std::find(c.nodes.begin(), c.nodes.end(), -1) == c.nodes.end();
    };
    for (Cell& c : mesh.cells) renumber(c);
    for (auto& [region_name, region] : mesh.regions)
      for (Cell& c : region.cells)
        if (!renumber(c) && !mesh.left_out.contains(region_name))
          mesh.left_out[region_name] = path_ + ": the physical group \"" + region_name + "\" has a " + std::string(name(c.kind)) +
                                       " that is not part of any " + std::array{"line", "surface", "solid"}[at(mesh.dim - 1)] +
                                       " cell of the mesh, so it is no region.";
    for (const auto& [region_name, reason] : mesh.left_out) {
      mesh.regions.erase(region_name);
      mesh.warnings.push_back(reason);
    }
    return numbers;
  }

  void join_periodic(Mesh& mesh, const std::vector<int>& numbers) const {
    std::vector<PeriodicSide> sides(content_.periodic.size());
    for (std::size_t i = 0; i < sides.size(); ++i)
      for (const auto& [copy, original] : content_.periodic[i])
        if (numbers[at(copy)] >= 0 && numbers[at(original)] >= 0) sides[i].emplace_back(numbers[at(copy)], numbers[at(original)]);
    try {
      join_nodes(mesh, sides);
    } catch (const InputError& e) {
      throw InputError(path_ + ", section $Periodic: " + e.what());
    }
  }

  void refuse_folds(const Mesh& mesh) const {
    const std::optional<Fold> fold = first_fold(mesh);
    if (!fold) return;
    const Cell& cell = mesh.cells[at(fold->cell)];
    static constexpr std::array<const char*, 3> measure = {"length", "area", "volume"};
    throw InputError(fmt::format(
        "{}: {} {} is folded over itself at ({:.6g}, {:.6g}, {:.6g}): its {} by reference {} there is {:.3g} and elsewhere up to {:.3g}. {}", path_,
        name(cell.kind), content_.layers[at(mesh.dim)].tags[at(fold->cell)], fold->place[0], fold->place[1], fold->place[2],
        measure[at(mesh.dim - 1)], measure[at(mesh.dim - 1)], fold->least, fold->most,
        cell.order > 1
            ? "Gmsh unfolds curved cells with Mesh.HighOrderOptimize = 2 (gmsh -optimize_ho); smaller cells at the curved boundary help, too."
            : "All corners must be convex; smaller cells there help."));
  }

  std::string path_;
  GmshContent content_;
  PeriodicSides sides_;
};

}  // namespace

Mesh read_gmsh(const std::string& path, PeriodicSides sides) { return Assembler(path, read_gmsh_content(path), sides).assemble(); }

}  // namespace karcher
