#pragma once
/// \file
/// Meshes of simple shapes from a few numbers. One table says what every generator takes; the problem file, `karcher list meshes` and `karcher doc
/// mesh.generate` read it.

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "karcher/mesh/mesh.hpp"

namespace karcher {

/// An argument: some numbers, or a choice between words.
struct GeneratorArgument {
  std::string name;
  std::string unit;  ///< "length", "angle" (radians), "1"
  std::string description;
  std::vector<double> numbers;     ///< default; as many numbers as the argument has
  std::vector<std::string> words;  ///< for a choice: what is allowed, the default first
  double minimum = -std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< false: must be greater than minimum
  bool integer = false;

  bool is_choice() const { return !words.empty(); }
};

struct GeneratorInfo {
  std::string name;
  std::string description;  ///< what comes out, with the formula
  std::vector<GeneratorArgument> arguments;
  std::vector<std::string> regions;  ///< names of the boundary pieces (those of a closed mesh are missing)
};

/// All generators, in the order of the documentation.
const std::vector<GeneratorInfo>& generators();
/// \throws InputError naming the known generators and the nearest.
const GeneratorInfo& generator(const std::string& name);

struct GeneratorOptions {
  std::string name;
  std::map<std::string, std::vector<double>> numbers{};  ///< arguments that are numbers; missing ones have their defaults
  std::map<std::string, std::string> words{};            ///< arguments that are choices
};

/// The mesh, with region "all", the regions of its boundary pieces, and "boundary" if it has a boundary. Nodes lie on the exact surface, and so do
/// those of its refinements. \throws InputError for unknown generators and arguments, numbers out of range, and meshes too coarse around (less than
/// three cells).
Mesh generate(const GeneratorOptions& options);

}  // namespace karcher
