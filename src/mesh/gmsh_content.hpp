#pragma once
/// \file
/// What a Gmsh file says, before it becomes a mesh.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "karcher/mesh/periodic.hpp"

namespace karcher {

/// Sets of physical tags by number; 0 is the empty set.
class GmshGroups {
 public:
  GmshGroups() { number({}); }
  int number(std::vector<int> tags);
  /// Ascending.
  const std::vector<int>& tags(int number) const { return sets_[static_cast<std::size_t>(number)]; }
  int count() const { return static_cast<int>(sets_.size()); }

 private:
  std::vector<std::vector<int>> sets_;
  std::map<std::vector<int>, int> numbers_;
};

/// Cells of one dimension, each with the number of its set of physical tags, and its own tag.
struct GmshLayer {
  std::vector<Cell> cells;
  std::vector<int> groups;
  std::vector<std::int64_t> tags;
};

struct GmshContent {
  int version = 0;                     ///< 2 or 4
  std::vector<PeriodicSide> periodic;  ///< nodes that $Periodic makes one, by their numbers
  std::vector<Vec3<double>> nodes;
  std::array<GmshLayer, 4> layers;                   ///< by dimension; nodes of cells are numbers into `nodes`, in our order
  std::map<std::pair<int, int>, std::string> names;  ///< of physical groups, by dimension and tag
  GmshGroups groups;
};

/// \throws InputError as read_gmsh does for everything that one section tells
GmshContent read_gmsh_content(const std::string& path);

}  // namespace karcher
