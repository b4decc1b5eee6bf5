#pragma once
/// \file
/// The Cosserat plate with a flat reference in the plane z = 0 (Neff, "A geometrically exact Cosserat shell model including size effects, avoiding degeneracy in the thin shell
/// limit", Contin. Mech. Thermodyn. 16, 2004; Sander, Neff, Birsan, "Numerical treatment of a geometrically nonlinear planar Cosserat shell model", Comput. Mech. 57, 2016):
///   U = R^T (d_1 m | d_2 m | R e_3),  K_b = (R^T d_1 R e_3 | R^T d_2 R e_3 | 0),  K = R^T grad R,  W = h Wmemb(U) + h^3/12 Wbend(K_b) + h Wcurv(K)
///   Wmemb(U) = mu |sym(U - I)|^2 + mu_c |skew(U - I)|^2 + mu lambda/(2 mu + lambda) 1/2 ((det U - 1)^2 + (1/det U - 1)^2)
///   Wbend(K_b) = mu |sym K_b|^2 + mu_c |skew K_b|^2 + mu lambda/(2 mu + lambda) (tr K_b)^2
///   Wcurv(K) = mu L_c^(1+p) |K|^(1+p), |K| in Frobenius' norm of all 18 entries: |K|^2 = 2 sum |axl(R^T d_a R)|^2
/// W is infinite where det U <= 0.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "karcher/energy/body_strains.hpp"
#include "karcher/energy/energy_info.hpp"
#include "karcher/math/functions.hpp"

namespace karcher {

namespace plate_detail {

/// x^q, q >= 1, for an x that is a sum of squares. Where x vanishes, so do its first derivatives, and the second one of x^q, infinite there for q < 2, counts nothing.
template <class P>
struct PowerOfSquares {
  P exponent;
  template <int Order, class T>
  std::array<T, static_cast<std::size_t>(Order + 1)> derivatives(const T& x) const {
    constexpr double smallest = 1e-200;  // its inverse is a number
    std::array<T, static_cast<std::size_t>(Order + 1)> f;
    for (int l = 0; l < lanes<T>; ++l) {
      double factor = 1;
      for (std::size_t n = 0; n < f.size(); ++n) {
        const double e = lane(exponent, l) - static_cast<double>(n);
        const bool counts = factor != 0 && (e >= 0 || lane(x, l) > smallest);
        set_lane(f[n], l, counts ? factor * (e == 1 ? lane(x, l) : std::pow(lane(x, l), e)) : 0.0);
        factor *= e;
      }
    }
    return f;
  }
};

/// 1/2 ((x - 1)^2 + (1/x - 1)^2) for x > 0.
struct ChangeOfArea {
  template <int Order, class T>
  std::array<T, static_cast<std::size_t>(Order + 1)> derivatives(const T& x) const {
    static_assert(Order <= 2);
    std::array<T, static_cast<std::size_t>(Order + 1)> f;
    const T r = T(1.0) / x, s = r - T(1.0);
    f[0] = T(0.5) * ((x - T(1.0)) * (x - T(1.0)) + s * s);
    if constexpr (Order > 0) f[1] = x - T(1.0) - s * r * r;
    if constexpr (Order > 1) f[2] = T(1.0) + (T(3.0) * r - T(2.0)) * r * r * r;
    return f;
  }
};

}  // namespace plate_detail

template <class P>
struct CosseratPlate {
  P thickness, mu, lambda, mu_c, L_c, p;
  static CosseratPlate of(std::span<const P> all) { return {all[0], all[1], all[2], all[3], all[4], all[5]}; }

  template <class W, class S>
  void add_parts(const BodyStrains<2, S>& e, W& membrane, W& bending, W& curvature) const {
    const Vec3<S>&v1 = e.v[0], &v2 = e.v[1], &u1 = e.u[0], &u2 = e.u[1];
    const P h = thickness, h3 = h * h * h * (1.0 / 12), plane = mu * lambda / (2.0 * mu + lambda);

    add_square(membrane, v1[0] - 1.0, h * mu);
    add_square(membrane, v2[1] - 1.0, h * mu);
    add_square(membrane, v2[0] + v1[1], 0.5 * h * mu);
    add_square(membrane, v2[0] - v1[1], 0.5 * h * mu_c);
    add_square(membrane, v1[2], 0.5 * h * (mu + mu_c));
    add_square(membrane, v2[2], 0.5 * h * (mu + mu_c));
    W area(0.0);  // det U
    add_product(area, v1[0], v2[1]);
    add_product(area, -v1[1], v2[0]);
    const auto possible = base(area) > P(0.0);
    add_scaled(membrane, evaluate(plate_detail::ChangeOfArea{}, select(possible, area, W(1.0))), P(h * plane));
    membrane += constant<W>(select(possible, P(0.0), P(std::numeric_limits<double>::infinity())));

    // K_b has the rows (u1_2, u2_2), (-u1_1, -u2_1).
    add_square(bending, u1[1], h3 * mu);
    add_square(bending, u2[0], h3 * mu);
    add_square(bending, u2[1] - u1[0], 0.5 * h3 * mu);
    add_square(bending, u2[1] + u1[0], 0.5 * h3 * mu_c);
    add_square(bending, u1[1] - u2[0], h3 * plane);

    W square(0.0);  // L_c^2 |K|^2
    for (const Vec3<S>& u : e.u)
      for (int i = 0; i < 3; ++i) add_square(square, u[i], 2.0 * L_c * L_c);
    add_scaled(curvature, evaluate(plate_detail::PowerOfSquares<P>{0.5 * (1.0 + p)}, square), P(h * mu));
  }
  template <class W, class S>
  void add_energy(W& w, const BodyStrains<2, S>& e) const {
    add_parts(e, w, w, w);
  }
  template <class M, class Q>
  auto operator()(const M& m, const Q& q) const {
    const auto e = body_strains(m, q);
    std::decay_t<decltype(e.v[0][0])> w(0.0);
    add_energy(w, e);
    return w;
  }
  /// membrane, bending, curvature
  template <class M, class Q>
  auto parts(const M& m, const Q& q) const {
    const auto e = body_strains(m, q);
    using S = std::decay_t<decltype(e.v[0][0])>;
    std::array<S, 3> w{S(0.0), S(0.0), S(0.0)};
    add_parts(e, w[0], w[1], w[2]);
    return w;
  }

  static std::vector<QuantityInfo> quantity_infos() { return {{"strain", "1", 1, "size of the strains, |U - I| + h/2 |K_b|", 0.2}}; }
  template <class S, class M, class Q>
  auto quantities(const S&, const M& m, const Q& q) const {
    const auto e = body_strains(m, q);
    const Vec3<P> first = e.v[0] - Vec3<P>{{P(1.0), P(0.0), P(0.0)}}, second = e.v[1] - Vec3<P>{{P(0.0), P(1.0), P(0.0)}};
    const P bending = e.u[0][0] * e.u[0][0] + e.u[0][1] * e.u[0][1] + e.u[1][0] * e.u[1][0] + e.u[1][1] * e.u[1][1];
    return std::array<P, 1>{sqrt(norm2(first) + norm2(second)) + 0.5 * thickness * sqrt(bending)};
  }
};

}  // namespace karcher
