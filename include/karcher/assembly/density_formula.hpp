#pragma once
/// \file
/// DensityFormula: a density that is a Program, for a term whose fields and formula are known at run time only.

#include <cstddef>
#include <vector>

#include "karcher/energy/parameter.hpp"
#include "karcher/expression/program.hpp"

namespace karcher {

/// The variables of the program, in this order: the point of the mesh; field after field its value, the derivatives of it along the axes x, y, z (on curves and
/// surfaces), and those along the directions t_1, t_2, t_3 (reference_point.hpp), all in ambient coordinates; parameters.
class DensityVariables {
 public:
  static constexpr std::size_t point = 0;

  /// \param ambient  numbers of ambient coordinates of the fields
  explicit DensityVariables(const std::vector<int>& ambient) {
    for (const int n : ambient) {
      first_.push_back(parameters_);
      ambient_.push_back(static_cast<std::size_t>(n));
      parameters_ += 7 * ambient_.back();
    }
  }
  std::size_t value(std::size_t field) const { return first_[field]; }
  std::size_t axis(std::size_t field, std::size_t axis) const { return first_[field] + (1 + axis) * ambient_[field]; }
  std::size_t direction(std::size_t field, std::size_t a) const { return first_[field] + (4 + a) * ambient_[field]; }
  std::size_t end(std::size_t field) const { return first_[field] + 7 * ambient_[field]; }
  std::size_t parameters() const { return parameters_; }

 private:
  std::vector<std::size_t> first_, ambient_;
  std::size_t parameters_ = 3;
};

struct DensityFormula {
  Program program;
  std::vector<ParameterValue> parameters;
};

}  // namespace karcher
