#pragma once
/// \file
/// The laws of a manifold, for every type that models the concept, the built-in ones and yours. In a test file with GoogleTest:
///
///     KARCHER_MANIFOLD_LAWS(MyManifoldTest, MyManifold)
///
/// or anywhere: `for (const std::string& s : manifold_laws<MyManifold>()) std::cerr << s << "\n";`. No sentence means that all laws hold:
///   frame       orthonormal in the metric
///   exp, log    exp_p(0) = p; log inverts exp for lengths from 1e-12 to the injectivity radius less 1e-6; lengths are distances; the distance is symmetric and
///               obeys the triangle inequality; both ends agree on the midpoint
///   metric      geodesics have constant speed; the gradient of dist^2(., p)/2 is -log (by jets)
///   linear      a type that says it is linear (traits.hpp) is R^n: exp_p(a) = p + a, log_p(q) = q - p, and the frame is the identity
///   values      stay on the manifold over many steps (where M::defect exists)
///   projection  idempotent, closer than other points nearby; chord is tangent, vanishes at equal points, derivative symmetric positive definite
///   scalars     packs agree with double lane by lane; jets have the values of double, and derivatives that pass Taylor tests with slopes 2 and 3, also at
///               coinciding points; third derivatives (Dual over Jet) agree with differences of second ones

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "karcher/manifold/traits.hpp"
#include "karcher/math/functions.hpp"
#include "karcher/testing/derivative_checks.hpp"
#include "karcher/testing/random.hpp"

namespace karcher {

template <class M>
struct ManifoldLawOptions {
  std::uint64_t seed = 1;
  int samples = 60;
  /// Rounding that is forgiven, relative to lengths of about 1 (times radius/(radius - length) towards the cut locus).
  double tolerance = 1e-12;
  /// Largest length where the injectivity radius is infinite.
  double reach = 2;
  /// Random points; default: two steps of random length from M::origin().
  std::function<Point<M>(Random&)> point;
};

namespace law_detail {

template <class M>
class Laws {
  static constexpr int n = M::ambient, k = M::dim;
  using P = Point<M>;
  using V = Vec<double, k>;

 public:
  explicit Laws(ManifoldLawOptions<M> options) : options_(std::move(options)), random_(options_.seed) {
    bounded_ = M::injectivity_radius < 1e300;
    radius_ = bounded_ ? static_cast<double>(M::injectivity_radius) : options_.reach;
  }

  std::vector<std::string> run() {
    if constexpr (!requires { M::origin(); }) {
      if (!options_.point) {
        fail("The laws need a point to begin with", "give M::origin() or options.point");
        return found_;
      }
    }
    for (int i = 0; i < options_.samples; ++i) {
      const P p = point();
      frame(p);
      inverse(p);
      distances(p);
      metric(p);
      if constexpr (is_linear<M>) linear(p);
      if constexpr (HasProjection<M>) projection(p);
      derivatives(p);
    }
    coinciding(point());
    for (int i = 0; i < 4; ++i) third_derivatives(point());
    if constexpr (requires(P x) { M::defect(x); }) staying();
    packs();
    return found_;
  }

 private:
  // One sentence for each law, the first violation.
  void fail(const std::string& law, const std::string& detail) {
    for (const auto& l : violated_)
      if (l == law) return;
    violated_.push_back(law);
    found_.push_back(std::string(M::name) + ": " + law + ": " + detail);
  }
  // NaN is a violation.
  void expect_below(double value, double limit, const std::string& law, double at = std::numeric_limits<double>::quiet_NaN()) {
    if (value <= limit) return;
    std::ostringstream s;
    s.precision(6);
    s << "error " << value << " is above " << limit;
    if (at == at) s << " at the length " << at;
    fail(law, s.str());
  }

  P point() {
    if (options_.point) return options_.point(random_);
    if constexpr (requires { M::origin(); }) {
      P p = M::origin();
      for (int i = 0; i < 2; ++i) p = retract<M>(p, random_.uniform(0, 0.5 * radius_) * random_.template direction<k>());
      return p;
    }
    return {};
  }
  // Lengths crowd at 0 and at the radius.
  double length() {
    switch (random_.uniform() < 0.5 ? 0 : random_.uniform() < 0.5 ? 1 : 2) {
      case 0:
        return random_.log_uniform(1e-12, radius_);
      case 1:
        return radius_ - random_.log_uniform(1e-6, radius_);
      default:
        return random_.uniform(0, radius_);
    }
  }
  double amplification(double r) const { return bounded_ ? radius_ / (radius_ - r) : 1.0; }
  static double norm(const V& v) { return std::sqrt(norm2(v)); }
  static V coordinates_at(const P& p, const P& a) { return coordinates<M>(p, M::frame(p), a); }
  static double gap(const P& p, const P& q) { return std::sqrt(norm2(p - q)) / std::max(1.0, std::sqrt(norm2(p))); }

  void frame(const P& p) {
    const auto e = M::frame(p);
    double error = 0;
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j) error = std::max(error, std::abs(M::inner(p, column(e, i), column(e, j)) - (i == j ? 1 : 0)));
    expect_below(error, options_.tolerance, "the frame is not orthonormal");
  }

  void inverse(const P& p) {
    expect_below(gap(M::exp(p, P{}), p), options_.tolerance, "exp_p(0) is not p");
    const double r = length();
    const V v = r * random_.template direction<k>();
    const P q = retract<M>(p, v);
    expect_below(norm(coordinates_at(p, M::log(p, q)) - v), options_.tolerance * amplification(r), "log does not invert exp", r);
    const P back = M::exp(p, M::log(p, q));
    expect_below(gap(back, q), options_.tolerance * amplification(r), "exp does not invert log", r);
    expect_below(std::abs(distance<M>(p, q) - r), options_.tolerance * amplification(r), "the distance is not the length of the geodesic", r);
  }

  void distances(const P& p) {
    const P q = point();
    const double pq = distance<M>(p, q), qp = distance<M>(q, p);
    if (bounded_ && pq > 0.99 * radius_) return;
    expect_below(distance<M>(p, p), options_.tolerance, "a point has a distance from itself");
    expect_below(std::abs(pq - qp), options_.tolerance, "the distance is not symmetric", pq);
    const double there = norm(coordinates_at(p, M::log(p, q))), back = norm(coordinates_at(q, M::log(q, p)));
    expect_below(std::abs(there - back), 100 * options_.tolerance, "log_p q and log_q p have different lengths", pq);
    expect_below(std::abs(there - pq), 100 * options_.tolerance, "log and the distance do not agree", pq);
    const P s = point();
    expect_below(pq - distance<M>(p, s) - distance<M>(s, q), options_.tolerance, "the triangle inequality is violated", pq);
    const P middle = M::exp(p, 0.5 * M::log(p, q)), other = M::exp(q, 0.5 * M::log(q, p));
    expect_below(distance<M>(middle, other), 1000 * options_.tolerance, "the midpoint depends on the end from which it is found", pq);
  }

  void metric(const P& p) {
    const double r = std::min(length(), 0.99 * radius_);
    const V v = r * random_.template direction<k>();
    using J = Jet<double, 1>;
    const double t = random_.uniform(0, 1);
    const auto moving = M::exp(cast<J>(p), J::variable(t, 0) * cast<J>(M::frame(p) * v));
    P q, velocity;
    for (int i = 0; i < n; ++i) {
      q[i] = moving[i].v;
      velocity[i] = moving[i].gradient(0);
    }
    expect_below(std::abs(std::sqrt(M::inner(q, velocity, velocity)) - r), 10 * options_.tolerance, "a geodesic changes its speed", r);

    // gradient of dist^2/2
    using JK = Jet<double, k>;
    Vec<JK, k> w;
    for (int i = 0; i < k; ++i) w[i] = JK::variable(0, i);
    const P end = retract<M>(p, v);
    const auto around = M::exp(cast<JK>(end), cast<JK>(M::frame(end)) * w);
    const auto a = M::log(cast<JK>(p), around);
    const JK half = 0.5 * M::inner(cast<JK>(p), a, a);
    const V back = coordinates_at(end, M::log(end, p));
    double error = 0;
    for (int i = 0; i < k; ++i) error = std::max(error, std::abs(half.gradient(i) + back[i]));
    expect_below(error, 100 * options_.tolerance, "the gradient of half the squared distance is not -log", r);
  }

  void linear(const P& p) {
    static_assert(n == k, "A linear manifold has as many tangent coordinates as ambient ones.");
    const V v = length() * random_.template direction<k>();
    const P q = p + v;
    expect_below(gap(M::exp(p, v), q), options_.tolerance, "the manifold is not linear, exp_p(a) is not p + a");
    expect_below(gap(M::log(p, q), q - p), options_.tolerance, "the manifold is not linear, log_p(q) is not q - p");
    expect_below(std::sqrt(norm2(M::frame(p) - identity<double, n>())), options_.tolerance,
                 "the manifold is not linear, the frame is not the identity");
  }

  void projection(const P& p) {
    if constexpr (HasProjection<M>) {
      expect_below(gap(M::project(p), p), options_.tolerance, "project moves a point of the manifold");
      P x = p;
      for (int i = 0; i < n; ++i) x[i] += 0.2 * random_.normal() / std::sqrt(n);
      const P q = M::project(x);
      expect_below(gap(M::project(q), q), options_.tolerance, "project is not idempotent");
      for (int i = 0; i < 5; ++i) {
        const P other = retract<M>(q, random_.log_uniform(1e-3, 0.5) * random_.template direction<k>());
        expect_below(norm2(x - q) - norm2(x - other), options_.tolerance, "another point is closer than the projection");
      }
      const auto e = M::frame(p);
      const P c = M::chord(p, point());
      expect_below(gap(e * coordinates_at(p, c), c), options_.tolerance, "chord is not a tangent vector");
      using J = Jet<double, k>;
      Vec<J, k> w;
      for (int i = 0; i < k; ++i) w[i] = J::variable(0, i);
      const auto chord = M::chord(cast<J>(p), M::exp(cast<J>(p), cast<J>(e) * w));
      Mat<double, k, k> g;
      double value = 0;
      for (int i = 0; i < k; ++i) {
        const J ci = M::inner(cast<J>(p), cast<J>(column(e, i)), chord);
        value = std::max(value, std::abs(ci.v));
        for (int j = 0; j < k; ++j) g(i, j) = ci.gradient(j);
      }
      expect_below(value, options_.tolerance, "chord does not vanish at equal points");
      double skewness = 0, smallest = 1;
      for (int i = 0; i < k; ++i) {
        for (int j = 0; j < k; ++j) skewness = std::max(skewness, std::abs(g(i, j) - g(j, i)));
        double others = 0;
        for (int j = 0; j < k; ++j) others += j == i ? 0 : std::abs(g(i, j));
        smallest = std::min(smallest, g(i, i) - others);
      }
      expect_below(skewness, options_.tolerance, "the derivative of chord is not symmetric");
      expect_below(-smallest, -options_.tolerance, "the derivative of chord is not positive definite");
    }
  }

  // c . exp_p(E v) in v, and c . log(exp_p(E v), exp_q(E w)) in (v, w), along random lines, against jets. Where the third derivative along a line happens to
  // vanish the slope is blurred, so only a point where three lines fail counts.
  void derivatives(const P& p) {
    const double r = std::min(length(), 0.8 * radius_);
    const V v = r * random_.template direction<k>();
    const P q = retract<M>(p, v);
    const double size = std::max({1.0, norm2(p), norm2(q)});
    std::string wrong_exp, wrong_log;
    for (int line = 0; line < 3; ++line) {
      const P c = random_.template direction<n>();
      const V dv = random_.template direction<k>(), dw = random_.template direction<k>();
      const auto exp_along = [&](const auto& t) {
        using S = std::decay_t<decltype(t)>;
        return dot(cast<S>(c), M::exp(cast<S>(p), cast<S>(M::frame(p)) * (cast<S>(v) + t * cast<S>(dv))));
      };
      const auto log_along = [&](const auto& t) {
        using S = std::decay_t<decltype(t)>;
        const auto a = M::exp(cast<S>(p), t * cast<S>(M::frame(p) * dv));
        const auto b = M::exp(cast<S>(q), t * cast<S>(M::frame(q) * dw));
        return dot(cast<S>(c), M::log(a, b));
      };
      if (line == 0 || !wrong_exp.empty()) wrong_exp = slopes(exp_along, "exp", r, size);
      if (line == 0 || !wrong_log.empty()) wrong_log = slopes(log_along, "log", r, size);
    }
    if (!wrong_exp.empty()) fail("derivatives of exp are wrong", wrong_exp);
    if (!wrong_log.empty()) fail("derivatives of log are wrong", wrong_log);
  }
  template <class F>
  std::string slopes(const F& f, const std::string& what, double r, double size) {
    using J = Jet<double, 1>;
    const J j = f(J::variable(0, 0));
    const double value = f(0.0);
    expect_below(std::abs(j.v - value), options_.tolerance * size, "the value of a jet of " + what + " is not that of double", r);
    // Products of coordinates are rounded: that is the noise of the remainders.
    const double rounding = 3000 * std::numeric_limits<double>::epsilon() * size;
    const TaylorSlopes s = taylor_slopes(f, value, j.gradient(0), j.hessian(0, 0), 0.05, rounding);
    return s.hessian_holds() ? "" : s.sentence();
  }

  // At q = p: log_p(exp_p(E w)) = E w to second order in w.
  void coinciding(const P& p) {
    using J = Jet<double, k>;
    Vec<J, k> w;
    for (int i = 0; i < k; ++i) w[i] = J::variable(0, i);
    const auto e = cast<J>(M::frame(p));
    const auto a = M::log(cast<J>(p), M::exp(cast<J>(p), e * w));
    double error = 0;
    for (int i = 0; i < k; ++i) {
      const J x = M::inner(cast<J>(p), column(e, i), a) - w[i];
      error = std::max(error, std::abs(x.v));
      for (const double g : x.g) error = std::max(error, std::abs(g));
      for (const double h : x.h) error = std::max(error, std::abs(h));
      for (const double h : x.h)
        if (h != h) error = h;
    }
    expect_below(error, 10 * options_.tolerance, "derivatives of log at coinciding points are wrong");
  }

  void third_derivatives(const P& p) {
    const V v = std::min(1.0, 0.4 * radius_) * random_.template direction<k>(), dv = random_.template direction<k>();
    const P q = retract<M>(p, v);
    const auto f = [&](const auto& x, const auto& y) {
      using S = std::decay_t<decltype(x)>;
      return M::log(M::exp(cast<S>(p), x * cast<S>(M::frame(p) * dv)), M::exp(cast<S>(q), y * cast<S>(M::frame(q) * dv)));
    };
    using J = Jet<double, 1>;
    using D = Dual<J, 1>;
    const double t = 1e-4;
    D x = J::variable(0, 0), y = J::variable(0, 0);
    y.d[0] = J(1.0);
    const auto exact = f(x, y);
    const auto plus = f(J::variable(0, 0), J::variable(t, 0)), minus = f(J::variable(0, 0), J::variable(-t, 0));
    double error = 0;
    for (int i = 0; i < n; ++i) {
      error = std::max(error, std::abs(exact[i].d[0].v - (plus[i].v - minus[i].v) / (2 * t)));
      error = std::max(error, std::abs(exact[i].d[0].gradient(0) - (plus[i].gradient(0) - minus[i].gradient(0)) / (2 * t)));
      error = std::max(error, std::abs(exact[i].d[0].hessian(0, 0) - (plus[i].hessian(0, 0) - minus[i].hessian(0, 0)) / (2 * t)));
    }
    expect_below(error, 1e-5, "third derivatives of log are not those of the second ones");
  }

  void staying() {
    if constexpr (requires(P x) { M::defect(x); }) {
      P p = point();
      for (int i = 0; i < 300; ++i) {
        const double before = M::defect(p);
        P q = retract<M>(p, random_.log_uniform(1e-8, 0.3 * radius_) * random_.template direction<k>());
        // Unbounded manifolds: stay near.
        if constexpr (requires { M::origin(); })
          if (!bounded_ && distance<M>(M::origin(), q) > 2 * radius_) q = M::origin();
        expect_below(M::defect(q) - before, options_.tolerance, "exp leaves the manifold");
        p = q;
      }
      expect_below(M::defect(p), options_.tolerance, "points drift off the manifold");
    }
  }

  void packs() {
    compare_with_pack<Pack<4>>();
    if constexpr (native_width > 4) compare_with_pack<NativeScalar>();
  }
  template <class T>
  void compare_with_pack() {
    constexpr int W = lanes<T>;
    using J = Jet<double, 2>;
    using JT = Jet<T, 2>;
    for (int sample = 0; sample < options_.samples; ++sample) {
      Point<M, T> p, a, b;
      std::array<P, static_cast<std::size_t>(W)> ps, as, bs;
      for (int l = 0; l < W; ++l) {
        const auto i = static_cast<std::size_t>(l);
        ps[i] = point();
        as[i] = M::frame(ps[i]) * (std::min(length(), 0.9 * radius_) * random_.template direction<k>());
        bs[i] = M::frame(ps[i]) * random_.template direction<k>();
        for (int c = 0; c < n; ++c) {
          set_lane(p[c], l, ps[i][c]);
          set_lane(a[c], l, as[i][c]);
          set_lane(b[c], l, bs[i][c]);
        }
      }
      const auto run = []<class S>(const Point<M, S>& p0, const Point<M, S>& a0, const Point<M, S>& b0) {
        using JS = Jet<S, 2>;
        const auto moving = M::exp(cast<JS>(p0), cast<JS>(a0) + JS::variable(S(0.0), 0) * cast<JS>(b0));
        return M::log(M::exp(cast<JS>(p0), JS::variable(S(0.0), 1) * cast<JS>(b0)), moving);
      };
      const Point<M, T> q = M::exp(p, a), log = M::log(p, q);
      const auto frame = M::frame(p);
      const T inner = M::inner(p, a, b);
      const Vec<JT, n> packed = run(p, a, b);
      for (int l = 0; l < W; ++l) {
        const auto i = static_cast<std::size_t>(l);
        const P q0 = M::exp(ps[i], as[i]), log0 = M::log(ps[i], q0);
        const auto frame0 = M::frame(ps[i]);
        const Vec<J, n> one = run(ps[i], as[i], bs[i]);
        double error = std::abs(lane(inner, l) - M::inner(ps[i], as[i], bs[i]));
        for (int c = 0; c < n; ++c) {
          error = std::max({error, std::abs(lane(q[c], l) - q0[c]), std::abs(lane(log[c], l) - log0[c])});
          for (int d = 0; d < k; ++d) error = std::max(error, std::abs(lane(frame(c, d), l) - frame0(c, d)));
        }
        expect_below(error, 10 * options_.tolerance, "a pack differs from double");
        double jets = 0, size = 1;
        for (int c = 0; c < n; ++c) {
          for (std::size_t g = 0; g < 2; ++g) {
            jets = std::max(jets, std::abs(lane(packed[c].g[g], l) - one[c].g[g]));
            size = std::max(size, std::abs(one[c].g[g]));
          }
          for (std::size_t h = 0; h < 3; ++h) {
            jets = std::max(jets, std::abs(lane(packed[c].h[h], l) - one[c].h[h]));
            size = std::max(size, std::abs(one[c].h[h]));
          }
        }
        expect_below(jets / size, 100 * options_.tolerance, "derivatives in a pack differ from those at double");
      }
    }
  }

  ManifoldLawOptions<M> options_;
  Random random_;
  bool bounded_ = false;
  double radius_ = 1;
  std::vector<std::string> violated_, found_;
};

}  // namespace law_detail

/// One sentence for each violated law.
template <class M>
std::vector<std::string> manifold_laws(ManifoldLawOptions<M> options = {}) {
  static_assert(CheckManifold<M>::passed);
  return law_detail::Laws<M>(std::move(options)).run();
}

}  // namespace karcher

/// A GoogleTest (include <gtest/gtest.h> before use) of all laws of a manifold: KARCHER_MANIFOLD_LAWS(MyTest, MyManifold).
#define KARCHER_MANIFOLD_LAWS(suite, ...)                                                                \
  TEST(suite, ObeysTheLawsOfAManifold) {                                                                 \
    for (const std::string& violated : karcher::manifold_laws<__VA_ARGS__>()) ADD_FAILURE() << violated; \
  }
