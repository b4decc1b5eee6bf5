#pragma once
/// \file
/// Writes meshes in Gmsh's formats, for tests of the reader. Node numbers in the file have gaps (10, 17, 24, ...), as Gmsh's may.

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "karcher/mesh/mesh.hpp"
#include "karcher/mesh/periodic.hpp"
#include "mesh/gmsh_cells.hpp"

namespace karcher {

class MshWriter {
 public:
  MshWriter(int version, bool binary) : version_(version), binary_(binary) { out_.precision(17); }

  /// Regions become physical groups of these tags (0: written without a name); "all" is not written, cells of no region are.
  /// \param sides  become the section $Periodic, each with an affine map
  std::string write(const Mesh& mesh, const std::map<std::string, int>& tags, const std::vector<PeriodicSide>& sides = {}) {
    collect(mesh, tags);
    out_ << "$MeshFormat\n" << (version_ == 2 ? "2.2 " : "4.1 ") << (binary_ ? "1 8\n" : "0 8\n");
    if (binary_) {
      integer(1);
      out_ << "\n";
    }
    out_ << "$EndMeshFormat\n$PhysicalNames\n" << tags.size() << "\n";
    for (const auto& [name, tag] : tags) out_ << mesh.regions.at(name).dim << " " << tag << " \"" << name << "\"\n";
    out_ << "$EndPhysicalNames\n$Comments\nignored $Nodes\n$EndComments\n";
    version_ == 2 ? write_2(mesh) : write_4(mesh);
    if (!sides.empty()) write_periodic(sides);
    return out_.str();
  }

 private:
  struct Entry {
    Cell cell;
    std::set<int> tags;
  };

  static int type_of(const Cell& cell) {
    for (int type = 1; type < 100; ++type)
      if (const GmshCell* known = gmsh_cell(type); known && known->kind == cell.kind && known->order == cell.order) return type;
    return 0;
  }
  static std::int64_t node_tag(int node) { return 10 + 7 * static_cast<std::int64_t>(node); }
  static std::vector<std::int64_t> nodes_in_file_order(const Cell& cell) {
    const auto& permutation = gmsh_cell(type_of(cell))->permutation;
    std::vector<std::int64_t> nodes(permutation.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[static_cast<std::size_t>(permutation[i])] = node_tag(cell.nodes[i]);
    return nodes;
  }

  void collect(const Mesh& mesh, const std::map<std::string, int>& tags) {
    std::map<std::vector<int>, std::size_t> known;
    const auto add = [&](const Cell& c) -> Entry& {
      std::vector<int> key = c.nodes;
      std::sort(key.begin(), key.end());
      const auto [it, is_new] = known.emplace(key, entries_.size());
      if (is_new) entries_.push_back({c, {}});
      return entries_[it->second];
    };
    for (const auto& [name, tag] : tags)
      for (const Cell& c : mesh.regions.at(name).cells) add(c).tags.insert(tag);
    for (const Cell& c : mesh.cells) add(c);
  }

  template <class T>
  void raw(T value) {
    out_.write(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void integer(std::int32_t value) { binary_ ? raw(value) : void(out_ << value << " "); }
  void size(std::int64_t value) { binary_ ? raw(value) : void(out_ << value << " "); }
  void real(double value) { binary_ ? raw(value) : void(out_ << value << " "); }
  void line() {
    if (!binary_) out_ << "\n";
  }

  void write_2(const Mesh& mesh) {
    out_ << "$Nodes\n" << mesh.nodes.size() << "\n";
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      integer(static_cast<std::int32_t>(node_tag(static_cast<int>(n))));
      for (int i = 0; i < 3; ++i) real(mesh.nodes[n][i]);
      line();
    }
    out_ << "\n$EndNodes\n$Elements\n";
    std::size_t count = 0;
    for (const Entry& e : entries_) count += std::max<std::size_t>(1, e.tags.size());
    out_ << count << "\n";
    int number = 0;
    for (const Entry& e : entries_)
      for (int tag : e.tags.empty() ? std::set<int>{0} : e.tags) {  // once for every group
        if (binary_) {
          for (int i : {type_of(e.cell), 1, 2, ++number}) integer(i);
        } else {
          for (int i : {++number, type_of(e.cell), 2}) integer(i);
        }
        integer(tag);
        integer(1);
        for (auto n : nodes_in_file_order(e.cell)) integer(static_cast<std::int32_t>(n));
        line();
      }
    out_ << "\n$EndElements\n";
  }

  void write_4(const Mesh& mesh) {
    // An entity of the model for every dimension and set of groups.
    std::map<std::pair<int, std::set<int>>, std::vector<const Entry*>> models;
    for (const Entry& e : entries_) models[{dimension(e.cell.kind), e.tags}].push_back(&e);
    std::array<std::int64_t, 4> counts{};
    for (const auto& m : models) ++counts[static_cast<std::size_t>(m.first.first)];
    out_ << "$Entities\n";
    for (auto n : counts) size(n);
    line();
    int entity = 0;
    std::map<std::pair<int, std::set<int>>, int> numbers;
    for (const auto& m : models) {
      const auto& [dim, tags] = m.first;
      integer(numbers[m.first] = ++entity);
      for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) real(0.5);
      size(static_cast<std::int64_t>(tags.size()));
      for (int t : tags) integer(-t);  // the sign is an orientation
      if (dim > 0) {
        size(1);
        integer(3);
      }
      line();
    }
    out_ << "\n$EndEntities\n$Nodes\n";
    const auto nodes = static_cast<std::int64_t>(mesh.nodes.size());
    for (std::int64_t k : {std::int64_t{2}, nodes, std::int64_t{10}, node_tag(static_cast<int>(nodes))}) size(k);
    line();
    const std::int64_t half = nodes / 2;
    for (const auto& [begin, end, parametric] : {std::tuple{std::int64_t{0}, half, 0}, std::tuple{half, nodes, 1}}) {
      for (int k : {2, 1, parametric}) integer(k);
      size(end - begin);
      line();
      for (std::int64_t n = begin; n < end; ++n) size(node_tag(static_cast<int>(n)));
      line();
      for (std::int64_t n = begin; n < end; ++n) {
        for (int i = 0; i < 3; ++i) real(mesh.nodes[static_cast<std::size_t>(n)][i]);
        for (int i = 0; i < 2 * parametric; ++i) real(-1);
        line();
      }
    }
    out_ << "\n$EndNodes\n$Elements\n";
    std::map<std::tuple<int, std::set<int>, int>, std::vector<const Entry*>> blocks;
    for (const Entry& e : entries_) blocks[{dimension(e.cell.kind), e.tags, type_of(e.cell)}].push_back(&e);
    for (std::int64_t k : {static_cast<std::int64_t>(blocks.size()), static_cast<std::int64_t>(entries_.size()), std::int64_t{1}, std::int64_t{1}})
      size(k);
    line();
    std::int64_t number = 0;
    for (const auto& [key, block] : blocks) {
      const auto& [dim, tags, type] = key;
      for (int k : {dim, numbers.at({dim, tags}), type}) integer(k);
      size(static_cast<std::int64_t>(block.size()));
      line();
      for (const Entry* e : block) {
        size(++number);
        for (auto n : nodes_in_file_order(e->cell)) size(n);
        line();
      }
    }
    out_ << "\n$EndElements\n";
  }

  /// Of format 2.2 always as text, as Gmsh does.
  void write_periodic(const std::vector<PeriodicSide>& sides) {
    const bool binary = binary_;
    binary_ = binary && version_ == 4;
    out_ << "$Periodic\n";
    size(static_cast<std::int64_t>(sides.size()));
    line();
    for (const PeriodicSide& side : sides) {
      for (int k : {2, 5, 6}) integer(k);
      line();
      if (version_ == 2)
        out_ << "Affine 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n";
      else
        size(16);
      for (int k = 0; k < 16 && version_ == 4; ++k) real(k % 5 == 0 ? 1 : 0.25);
      line();
      size(static_cast<std::int64_t>(side.size()));
      line();
      for (const auto& [copy, original] : side) {
        size(node_tag(copy));
        size(node_tag(original));
        line();
      }
    }
    out_ << "\n$EndPeriodic\n";
    binary_ = binary;
  }

  int version_;
  bool binary_;
  std::vector<Entry> entries_;
  std::ostringstream out_;
};

}  // namespace karcher
