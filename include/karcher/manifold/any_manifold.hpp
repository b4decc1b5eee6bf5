#pragma once
/// \file
/// ManifoldOps: a manifold chosen at run time, as plain functions on arrays of doubles. Used where values are stored, moved and written; kernels use the types.

#include <string>
#include <vector>

#include "karcher/manifold/manifold.hpp"

namespace karcher {

struct ManifoldOps {
  std::string name;
  int ambient = 0;
  int dim = 0;
  double injectivity_radius = 0;
  bool has_projection = false;
  void (*retract)(const double* p, const double* v, double* q) = nullptr;  ///< q = retract(p, v), v: dim coordinates; q may be p
  void (*frame)(const double* p, double* e) = nullptr;                     ///< ambient x dim, row-major
  void (*exp)(const double* p, const double* a, double* q) = nullptr;      ///< ambient tangent vector a
  void (*log)(const double* p, const double* q, double* a) = nullptr;
  double (*dist)(const double* p, const double* q) = nullptr;
  double (*inner)(const double* p, const double* a, const double* b) = nullptr;
  /// Closest point for manifolds that have one; else a check-and-clean (symmetrise, normalise) of data that is a point up to rounding.
  /// Returns false where x is not (near) a point or the projection is not defined.
  bool (*make_point)(const double* x, double* p) = nullptr;
};

template <Manifold M>
const ManifoldOps& manifold_ops();

/// By the name used in problem files (R1 R2 R3 S1 S2 S3 SO3 SU2 SPD2 SPD3 H2 H3). \throws InputError with the known names and the nearest.
const ManifoldOps& manifold_by_name(const std::string& name);
std::vector<std::string> manifold_names();

}  // namespace karcher
