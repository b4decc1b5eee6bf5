#pragma once
/// \file
/// Expressions as trees: the form that automatic differentiation walks. muParser evaluates doubles only and shows no tree, so the text is parsed once more by
/// recursive descent, with muParser's grammar; a test compares the two.

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "karcher/math/dual.hpp"

namespace karcher::app {

/// A number with its derivatives in x, y, z.
using Slope = Dual<double, 3>;

struct Node {
  virtual ~Node() = default;
  /// \param variables x, y, z, t
  virtual Slope operator()(const std::array<Slope, 4>& variables) const = 0;
};
using Tree = std::shared_ptr<const Node>;

/// \param text a valid expression  \param named the tree of a parameter; null for an unknown name
/// \throws InputError for text that is not valid
Tree parse_tree(const std::string& text, const std::function<Tree(const std::string&)>& named);
Tree constant_tree(double value);

/// Names of the functions that both parsers know.
const std::vector<std::string>& function_names();

}  // namespace karcher::app
