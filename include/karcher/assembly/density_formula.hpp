#pragma once
/// \file
/// DensityFormula: a density that is a Program, for a term whose fields and formula are known at run time only.

#include <array>
#include <cstddef>
#include <vector>

#include "karcher/energy/parameter.hpp"
#include "karcher/expression/program.hpp"

namespace karcher {

/// The variables of the program, in this order: the point of the mesh; the directions t_a of the stress-free configuration (reference_point.hpp), along which
/// derivatives are taken, those that there are not 0; field after field its value and its derivatives along t_1, t_2, t_3; parameters.
struct DensityVariables {
  static constexpr std::size_t point = 0, tangents = 3, fields = 12;
  std::vector<std::size_t> field;  ///< the first of every field
  std::size_t parameters = 0;      ///< the first

  /// \param ambient  numbers of ambient coordinates of the fields
  explicit DensityVariables(const std::vector<int>& ambient) {
    std::size_t next = fields;
    for (const int n : ambient) {
      field.push_back(next);
      next += static_cast<std::size_t>(4 * n);
    }
    parameters = next;
  }
};

struct DensityFormula {
  Program program;
  std::vector<ParameterValue> parameters;
};

}  // namespace karcher
