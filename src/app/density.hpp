#pragma once
/// \file
/// The density of an energy as a formula of a problem file. Beside x, y, z, t and the parameters it names fields at the point; for a field u
///   u[0], u[1], ...               its ambient coordinates
///   u[0].x, u[0].y, u[0].z, ...   their derivatives along the axes: in solids, and those of the gradient on curves and surfaces
/// and where the values are rotations R
///   u.k1[0..2], u.k2[0..2], ...   axl(R^T d_a R) for the tangent directions t_a of the cell (reference_point.hpp)
///   u.d1[0..2], u.d2, u.d3        the columns of R, the directors
/// and what `let` has defined before.

#include <memory>
#include <string>
#include <vector>

#include "app/expression.hpp"
#include "app/toml_value.hpp"
#include "karcher/assembly/density_formula.hpp"
#include "karcher/manifold/any_manifold.hpp"

namespace karcher::app {

/// What is written, for messages and for the dimension that the region turns out to have.
class Density {
 public:
  struct Field {
    std::string name;
    const ManifoldOps* manifold;
  };
  /// A text of the file and its key for messages.
  struct Text {
    std::string key;
    Value value;
  };

  /// \param fields  of the energy  \param others  names of the fields that it does not have
  /// \throws InputError with the place of what is no formula, of a name that is not known or taken, of a field that the formula does not use
  Density(const Scope& scope, std::vector<Field> fields, std::vector<std::string> others, std::vector<Text> let, Text density);

  /// On regions of this dimension. \throws InputError with the place of a name that means nothing there
  DensityFormula formula(int directions) const;

 private:
  std::vector<Field> fields_;
  std::vector<std::string> others_;
  std::vector<Text> let_;
  Text density_;
  std::vector<std::pair<std::string, Expression>> parameters_;  ///< that are used
};

}  // namespace karcher::app
