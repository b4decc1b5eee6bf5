#pragma once

namespace karcher {

/// How a geometric finite element function is made of its nodal values p_i with Lagrange weights l_i(x) (negative ones included):
/// projection: the closest point of the manifold to sum l_i p_i; geodesic: the minimiser of sum l_i dist(q, p_i)^2 (weighted Riemannian mean).
/// The two agree on R^n, where both are plain Lagrange interpolation.
enum class Rule { projection, geodesic };

}  // namespace karcher
