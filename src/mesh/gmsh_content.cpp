#include "mesh/gmsh_content.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include "karcher/text.hpp"
#include "mesh/gmsh_cells.hpp"
#include "mesh/gmsh_input.hpp"

namespace karcher {
namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Tags of nodes, which may have gaps, to numbers from 0.
class NodeTags {
 public:
  /// As many tags are expected: those that are not much greater have their places in an array.
  void expect(std::int64_t nodes) { dense_limit_ = 8 * nodes + 1024; }
  bool insert(std::int64_t tag) {
    const int number = count_++;
    if (tag >= 0 && tag < dense_limit_) {
      if (at(tag) >= dense_.size()) dense_.resize(std::max(at(tag) + 1, 2 * dense_.size()), -1);
      if (dense_[at(tag)] >= 0) return false;
      dense_[at(tag)] = number;
      return true;
    }
    return sparse_.emplace(tag, number).second;
  }
  /// -1 if there is none
  int find(std::int64_t tag) const {
    if (tag >= 0 && tag < dense_limit_) return at(tag) < dense_.size() ? dense_[at(tag)] : -1;
    const auto it = sparse_.find(tag);
    return it == sparse_.end() ? -1 : it->second;
  }

 private:
  std::int64_t dense_limit_ = 0;
  std::vector<int> dense_;
  std::unordered_map<std::int64_t, int> sparse_;
  int count_ = 0;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : in_(path) {}

  GmshContent read() {
    while (!in_.at_end()) {
      const std::string_view token = in_.word();
      if (token.front() != '$') {
        if (content_.version == 0) in_.fail("this is not a Gmsh mesh file: it does not begin with $MeshFormat." + conversion());
        in_.fail("a section is expected, not \"" + std::string(token.substr(0, 40)) + "\".");
      }
      in_.section = token.substr(1);
      if (content_.version == 0 && in_.section != "MeshFormat" && in_.section != "Comments")
        in_.fail("the file must begin with $MeshFormat." + conversion());
      read_section();
    }
    if (content_.version == 0) in_.fail("this is not a Gmsh mesh file: it is empty.");
    if (!has_nodes_ || !has_cells_) in_.fail(std::string("there is no section ") + (has_nodes_ ? "$Elements." : "$Nodes."));
    return std::move(content_);
  }

 private:
  void read_section() {
    const std::string& section = in_.section;
    bool skipping = false;
    if (section == "MeshFormat")
      read_format();
    else if (section == "PhysicalNames")
      read_names();
    else if (section == "Entities" && content_.version == 4)
      read_entities(false);
    else if (section == "PartitionedEntities" && content_.version == 4)
      read_entities(true);
    else if (section == "Nodes" && content_.version == 4)
      read_nodes_4();
    else if (section == "Nodes" || (section == "ParametricNodes" && content_.version == 2))
      read_nodes_2(section == "ParametricNodes");
    else if (section == "Elements")
      content_.version == 4 ? read_cells_4() : read_cells_2();
    else if (section == "Periodic")
      read_periodic();
    else
      skipping = true;
    in_.end_section(skipping);
  }

  /// The command that makes a mesh file of what this seems to be.
  std::string conversion() const {
    const std::filesystem::path path = in_.path();
    const std::string ending = lower_case(path.extension().string());
    const std::string from = path.filename().string(), to = path.stem().string() + (ending == ".msh" ? "-41.msh" : ".msh");
    const auto among = [&](std::initializer_list<const char*> endings) { return std::find(endings.begin(), endings.end(), ending) != endings.end(); };
    if (among({".geo", ".step", ".stp", ".brep", ".iges", ".igs"}))
      return " It is a geometry: mesh it with `gmsh -2 -order 2 -format msh41 -o " + to + " " + from + "` (solids: -3).";
    if (among({".msh", ".unv", ".med", ".mesh", ".bdf", ".nas", ".vtk", ".cgns", ".stl", ".su2"}))
      return " Gmsh converts it: `gmsh -save -format msh41 -o " + to + " " + from + "`.";
    if (among({".vtu", ".inp", ".xdmf", ".xmf", ".e", ".ex2", ".exo", ".obj", ".off", ".ply", ".xml", ".mdpa", ".dat", ".fem", ".ugrid"}))
      return " meshio converts it: `meshio convert --output-format gmsh " + from + " " + to + "`.";
    return "";
  }

  void read_format() {
    const double version = in_.text_real();
    const int type = in_.text_integer(), width = in_.text_integer();
    if (version != 2.2 && version != 4.1)
      in_.fail("the file has MSH format " + std::string(version == 4 ? "4.0" : std::to_string(version).substr(0, 3)) +
               "; formats 2.2 and 4.1 are read (Gmsh: -format msh41)." + conversion());
    if (type != 0 && type != 1) in_.fail("the file type must be 0 (ASCII) or 1 (binary), not " + std::to_string(type) + ".");
    if (width != 8) in_.fail("numbers of " + std::to_string(width) + " bytes are not read, only of 8.");
    content_.version = version == 2.2 ? 2 : 4;
    if (type == 0) return;
    in_.binary = true;
    in_.skip_line_end();
    if (in_.integer() != 1) in_.fail("the binary data were written on a machine of other byte order.");
  }

  void read_names() {
    const int n = in_.text_integer();
    for (int i = 0; i < n; ++i) {
      const int dim = in_.text_integer(), tag = in_.text_integer();
      const std::string name = in_.quoted();
      // A group without a name has one of its tag.
      if (const std::string fault = fault_of_name(name); !fault.empty() && !name.empty())
        in_.fail("the physical name \"" + printable(name) + "\" " + fault + ".");
      content_.names[{dim, tag}] = name;
    }
  }

  /// Physical tags of the model's entities; partitioned meshes list theirs again.
  void read_entities(bool partitioned) {
    in_.skip_line_end();
    if (partitioned) {
      in_.size();
      const std::int64_t ghosts = in_.count(in_.size(), "ghost entities", 2);
      for (std::int64_t i = 0; i < 2 * ghosts; ++i) in_.integer();
    }
    std::array<std::int64_t, 4> counts{};
    for (auto& n : counts) n = in_.count(in_.size(), "entities", 2);
    for (int dim = 0; dim < 4; ++dim)
      for (std::int64_t i = 0; i < counts[at(dim)]; ++i) {
        const int tag = in_.integer();
        if (partitioned) {
          in_.integer();
          in_.integer();
          skip_integers("partitions");
        }
        for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) in_.real();
        std::vector<int> physical;
        const std::int64_t n = in_.count(in_.size(), "physical tags", 1);
        for (std::int64_t k = 0; k < n; ++k) physical.push_back(group_tag(in_.integer()));
        entity_groups_[{dim, tag}] = content_.groups.number(std::move(physical));
        if (dim > 0) skip_integers("bounding entities");
      }
  }

  /// The sign of a physical tag is the orientation in the group.
  int group_tag(int tag) {
    if (tag == std::numeric_limits<int>::min()) in_.fail("the physical tag " + std::to_string(tag) + " is out of range.");
    return std::abs(tag);
  }

  void skip_integers(const char* what) {
    const std::int64_t n = in_.count(in_.size(), what, 1);
    for (std::int64_t k = 0; k < n; ++k) in_.integer();
  }

  void start_nodes() {
    if (has_nodes_) in_.fail("the section occurs twice.");
    has_nodes_ = true;
  }

  Vec3<double> coordinates() {
    Vec3<double> x;
    for (int i = 0; i < 3; ++i) x[i] = in_.real();
    return x;
  }

  void add_node(std::int64_t tag, const Vec3<double>& x) {
    if (!tags_.insert(tag)) in_.fail("node " + std::to_string(tag) + " occurs twice.");
    if (!std::isfinite(norm2(x))) in_.fail("the coordinates of node " + std::to_string(tag) + " are not finite numbers.");
    content_.nodes.push_back(x);
  }

  /// Parametric nodes: behind the coordinates come the dimension and the tag of the model's entity, and the node's parameters on curves and surfaces.
  void read_nodes_2(bool parametric) {
    start_nodes();
    const std::int64_t n = in_.count(in_.text_integer(), "nodes", in_.binary ? 28 : 8);
    tags_.expect(n);
    if (in_.binary) in_.skip_line_end();
    for (std::int64_t i = 0; i < n; ++i) {
      const int tag = in_.integer();
      add_node(tag, coordinates());
      if (!parametric) continue;
      const int dim = in_.integer();
      if (dim < 0 || dim > 3) in_.fail("node " + std::to_string(tag) + " lies on an entity of dimension " + std::to_string(dim) + ".");
      in_.integer();
      for (int k = 0; k < dim && dim < 3; ++k) in_.real();
    }
  }

  void read_nodes_4() {
    start_nodes();
    in_.skip_line_end();
    const std::int64_t blocks = in_.count(in_.size(), "node blocks", 1);
    tags_.expect(in_.count(in_.size(), "nodes", in_.binary ? 32 : 8));
    in_.size();
    in_.size();
    for (std::int64_t b = 0; b < blocks; ++b) {
      const int dim = in_.integer();
      in_.integer();
      const int parametric = in_.integer();
      std::vector<std::int64_t> tags(at(in_.count(in_.size(), "nodes", in_.binary ? 32 : 8)));
      for (auto& tag : tags) tag = in_.size();
      for (const auto tag : tags) {
        const Vec3<double> x = coordinates();
        for (int k = 0; parametric && k < dim; ++k) in_.real();
        add_node(tag, x);
      }
    }
  }

  void start_cells() {
    if (!has_nodes_) in_.fail("the section must come after $Nodes.");
    if (has_cells_) in_.fail("the section occurs twice.");
    has_cells_ = true;
  }

  const GmshCell& cell_type(int type) const {
    const GmshCell* known = gmsh_cell(type);
    if (!known)
      in_.fail("cells of " + gmsh_unread(type) + ", are not read; lines, triangles, quadrilaterals, tetrahedra and hexahedra of order 1 to 3 are.");
    return *known;
  }

  /// The cell whose node tags `next` gives one after another.
  template <class Next>
  void add_cell(const GmshCell& type, std::int64_t tag, int group, Next next) {
    std::array<int, 64> nodes{};
    const std::size_t n = type.permutation.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t node = next();
      nodes[i] = tags_.find(node);
      if (nodes[i] < 0) in_.fail("cell " + std::to_string(tag) + " uses node " + std::to_string(node) + ", which is not in the file.");
    }
    GmshLayer& layer = content_.layers[at(dimension(type.kind))];
    Cell& cell = layer.cells.emplace_back();
    cell.kind = type.kind;
    cell.order = type.order;
    cell.nodes.reserve(n);
    for (int i : type.permutation) cell.nodes.push_back(nodes[at(i)]);
    layer.groups.push_back(group);
    layer.tags.push_back(tag);
  }

  void read_cells_2() {
    start_cells();
    std::int64_t n = in_.count(in_.text_integer(), "cells", 4);
    if (in_.binary) in_.skip_line_end();
    const auto cell = [&](const GmshCell& type, int tag, int tag_count) {
      std::vector<int> physical;
      for (int k = 0; k < tag_count; ++k) {
        const int t = in_.integer();
        if (k == 0 && t != 0) physical.push_back(group_tag(t));
      }
      add_cell(type, tag, content_.groups.number(std::move(physical)), [&] { return std::int64_t{in_.integer()}; });
    };
    while (n > 0) {
      if (in_.binary) {
        const GmshCell& type = cell_type(in_.integer());
        const std::int64_t following = in_.count(in_.integer(), "cells", 4);
        const int tag_count = in_.integer();
        if (following < 1) in_.fail("a block of cells is empty.");
        for (std::int64_t i = 0; i < following; ++i) cell(type, in_.integer(), tag_count);
        n -= following;
      } else {
        const int tag = in_.integer();
        const GmshCell& type = cell_type(in_.integer());
        cell(type, tag, in_.integer());
        --n;
      }
    }
  }

  void read_cells_4() {
    start_cells();
    in_.skip_line_end();
    const std::int64_t blocks = in_.count(in_.size(), "cell blocks", 1);
    in_.count(in_.size(), "cells", 4);
    in_.size();
    in_.size();
    for (std::int64_t b = 0; b < blocks; ++b) {
      const int dim = in_.integer(), entity = in_.integer();
      const GmshCell& type = cell_type(in_.integer());
      const std::int64_t n = in_.count(in_.size(), "cells", in_.binary ? 16 : 4);
      const auto found = entity_groups_.find({dim, entity});
      const int group = found == entity_groups_.end() ? 0 : found->second;
      for (std::int64_t i = 0; i < n; ++i) {
        const std::int64_t tag = in_.size();
        add_cell(type, tag, group, [&] { return in_.size(); });
      }
    }
  }

  /// Pairs of nodes; which entities of the model they lie on and the map between these (`Affine`) say nothing more. Gmsh writes the section of format 2.2 as text
  /// also in binary files.
  void read_periodic() {
    if (!has_nodes_) in_.fail("the section must come after $Nodes.");
    if (content_.version == 4) in_.skip_line_end();
    const bool text = content_.version == 2;
    const auto integer = [&] { return text ? in_.text_integer() : in_.integer(); };
    const auto size = [&] { return text ? std::int64_t{in_.text_integer()} : in_.size(); };
    const std::int64_t links = in_.count(size(), "periodic entities", 4);
    for (std::int64_t l = 0; l < links; ++l) {
      for (int k = 0; k < 3; ++k) integer();
      if (text) {
        if (in_.next_is("Affine")) in_.line();
      } else {
        const std::int64_t affine = in_.count(in_.size(), "numbers of an affine map", 1);
        for (std::int64_t k = 0; k < affine; ++k) in_.real();
      }
      const std::int64_t pairs = in_.count(size(), "pairs of nodes", 2);
      const auto node = [&] {
        const std::int64_t tag = size();
        const int number = tags_.find(tag);
        if (number < 0) in_.fail("it names node " + std::to_string(tag) + ", which is not in the file.");
        return number;
      };
      PeriodicSide& side = content_.periodic.emplace_back();
      for (std::int64_t k = 0; k < pairs; ++k) {
        const int copy = node();
        side.emplace_back(copy, node());
      }
    }
  }

  GmshInput in_;
  GmshContent content_;
  bool has_nodes_ = false, has_cells_ = false;
  std::map<std::pair<int, int>, int> entity_groups_;  ///< by dimension and entity tag
  NodeTags tags_;
};

}  // namespace

int GmshGroups::number(std::vector<int> tags) {
  std::sort(tags.begin(), tags.end());
  const auto [it, is_new] = numbers_.emplace(tags, count());
  if (is_new) sets_.push_back(std::move(tags));
  return it->second;
}

GmshContent read_gmsh_content(const std::string& path) { return Reader(path).read(); }

}  // namespace karcher
