#pragma once
/// \file
/// Elementary functions of every scalar: double and Pack by value, Jet and Dual with exact derivatives.
///
/// A function is a struct F that knows its derivatives f, f', ..., f^(n) at a plain value; `differentiate` carries it to nested scalars by the chain
/// rule. A user adds a function in the same way:
///
///     struct Square { template <int Order, class T> std::array<T, Order + 1> derivatives(const T& x) const; };
///     template <class X> X square(const X& x) { return evaluate(Square{}, x); }
///
/// Recursions for the derivatives come from the differential equation of each function (Abramowitz and Stegun, chapter 4).

#include <array>
#include <cmath>
#include <cstddef>

#include "karcher/math/pack_functions.hpp"
#include "karcher/math/scalar.hpp"

namespace karcher {

namespace function_detail {

template <class F, class T>
struct Evaluator {
  // Count consecutive derivatives of f, beginning with the First, at the plain value x.
  template <int First, int Count>
  static std::array<T, static_cast<std::size_t>(Count)> at(const F& f, const T& x) {
    const auto all = f.template derivatives<First + Count - 1>(x);
    std::array<T, static_cast<std::size_t>(Count)> r;
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = all[i + static_cast<std::size_t>(First)];
    return r;
  }
};

template <class F, class T, int N>
struct Evaluator<F, Jet<T, N>> {
  template <int First, int Count>
  static std::array<Jet<T, N>, static_cast<std::size_t>(Count)> at(const F& f, const Jet<T, N>& x) {
    const auto inner = Evaluator<F, T>::template at<First, Count + 2>(f, x.v);
    std::array<Jet<T, N>, static_cast<std::size_t>(Count)> r;
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = compose(x, inner[i], inner[i + 1], inner[i + 2]);
    return r;
  }
};

template <class F, class U, int D>
struct Evaluator<F, Dual<U, D>> {
  template <int First, int Count>
  static std::array<Dual<U, D>, static_cast<std::size_t>(Count)> at(const F& f, const Dual<U, D>& x) {
    const auto inner = Evaluator<F, U>::template at<First, Count + 1>(f, x.v);
    std::array<Dual<U, D>, static_cast<std::size_t>(Count)> r;
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = chain(x, inner[i], inner[i + 1]);
    return r;
  }
};

/// The function of a plain double in every lane.
template <class G>
double lanewise(G g, double x) {
  return g(x);
}
template <class G, int W>
Pack<W> lanewise(G g, const Pack<W>& x) {
  Pack<W> r;
  for (int l = 0; l < W; ++l) r.set(l, g(x[l]));
  return r;
}

inline double plain_exp(double x) { return std::exp(x); }
inline double plain_log(double x) { return std::log(x); }
template <int W>
Pack<W> plain_exp(const Pack<W>& x) {
  return pack_functions::exp(x);
}
template <int W>
Pack<W> plain_log(const Pack<W>& x) {
  return pack_functions::log(x);
}

}  // namespace function_detail

/// f, f', ..., f^(Count - 1) at any scalar.
template <int Count, class F, class X>
std::array<X, static_cast<std::size_t>(Count)> differentiate(const F& f, const X& x) {
  return function_detail::Evaluator<F, X>::template at<0, Count>(f, x);
}
/// f at any scalar.
template <class F, class X>
X evaluate(const F& f, const X& x) {
  return function_detail::Evaluator<F, X>::template at<0, 1>(f, x)[0];
}

namespace function_detail {

template <class T, int Order>
using Derivatives = std::array<T, static_cast<std::size_t>(Order + 1)>;

struct Sqrt {
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    using karcher::sqrt;
    Derivatives<T, Order> f;
    f[0] = sqrt(x);
    if constexpr (Order > 0) {
      f[1] = T(0.5) / f[0];
      const T r = T(1.0) / x;
      for (std::size_t n = 1; n < Order; ++n) f[n + 1] = f[n] * r * T(0.5 - static_cast<double>(n));
    }
    return f;
  }
};

struct Exp {
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    Derivatives<T, Order> f;
    f.fill(plain_exp(x));
    return f;
  }
};

struct Log {
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    Derivatives<T, Order> f;
    f[0] = plain_log(x);
    if constexpr (Order > 0) {
      f[1] = T(1.0) / x;
      for (std::size_t n = 1; n < Order; ++n) f[n + 1] = f[n] * f[1] * T(-static_cast<double>(n));
    }
    return f;
  }
};

/// log(1 + x) = log(y) x / (y - 1) with y = 1 + x rounded (Kahan; Higham, "Accuracy and Stability", 2002, section 1.14.1)
template <class T>
T plain_log1p(const T& x) {
  using karcher::abs;
  const T y = T(1.0) + x, rounded = y - T(1.0);
  const auto tiny = abs(rounded) <= T(0.0), small = x < T(1.0);
  return select(tiny, x, plain_log(y) * select(small, x / select(tiny, T(1.0), rounded), T(1.0)));
}

struct Log1p {
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    Derivatives<T, Order> f = Log{}.derivatives<Order>(T(1.0) + x);
    f[0] = plain_log1p(x);
    return f;
  }
};

struct Expm1 {
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    Derivatives<T, Order> f;
    f[0] = lanewise([](double y) { return std::expm1(y); }, x);
    for (std::size_t n = 1; n <= Order; ++n) f[n] = f[0] + T(1.0);
    return f;
  }
};

/// x^p for a constant real p. A derivative whose factor p (p-1) ... vanishes is zero also at x = 0.
struct Power {
  double exponent;
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    Derivatives<T, Order> f;
    double factor = 1;
    for (std::size_t n = 0; n <= Order; ++n) {
      const double e = exponent - static_cast<double>(n);
      f[n] = factor == 0 ? T(0.0) : T(factor) * lanewise([e](double y) { return std::pow(y, e); }, x);
      factor *= e;
    }
    return f;
  }
};

/// a cos x + b sin x.
struct Wave {
  double a, b;
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    const T c = lanewise([](double y) { return std::cos(y); }, x), s = lanewise([](double y) { return std::sin(y); }, x);
    Derivatives<T, Order> f;
    double p = a, q = b;
    for (std::size_t n = 0; n <= Order; ++n) {
      f[n] = p == 0 ? T(q) * s : q == 0 ? T(p) * c : T(p) * c + T(q) * s;
      const double t = p;
      p = q;
      q = -t;
    }
    return f;
  }
};

/// cosh x or sinh x.
struct HyperbolicWave {
  bool even;
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    const T c = lanewise([](double y) { return std::cosh(y); }, x), s = lanewise([](double y) { return std::sinh(y); }, x);
    Derivatives<T, Order> f;
    for (std::size_t n = 0; n <= Order; ++n) f[n] = (n % 2 == 0) == even ? c : s;
    return f;
  }
};

/// f' = 1 + sign f^2: tan (sign = 1) and tanh (sign = -1).
struct Tangent {
  int sign;
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    Derivatives<T, Order> f;
    const bool circular = sign > 0;
    f[0] = lanewise([circular](double y) { return circular ? std::tan(y) : std::tanh(y); }, x);
    for (std::size_t n = 0; n < Order; ++n) {
      T s = T(0.0);
      double binomial = 1;
      for (std::size_t k = 0; k <= n; ++k) {
        s += T(binomial) * f[k] * f[n - k];
        binomial *= static_cast<double>(n - k) / static_cast<double>(k + 1);
      }
      f[n + 1] = T(static_cast<double>(sign)) * s + T(n == 0 ? 1.0 : 0.0);
    }
    return f;
  }
};

/// Inverse functions with w f'' + m s x f' = 0, w = 1 + s x^2 (x^2 - 1 for acosh, s = 1): m = 1 for asin, acos, asinh, acosh, m = 2 for atan, atanh.
struct InverseFunction {
  enum Kind { asin, acos, atan, asinh, acosh, atanh } kind;
  static double value(Kind k, double y) {
    switch (k) {
      case asin:
        return std::asin(y);
      case acos:
        return std::acos(y);
      case atan:
        return std::atan(y);
      case asinh:
        return std::asinh(y);
      case acosh:
        return std::acosh(y);
      default:
        return std::atanh(y);
    }
  }
  template <int Order, class T>
  Derivatives<T, Order> derivatives(const T& x) const {
    using karcher::sqrt;
    const Kind k = kind;
    Derivatives<T, Order> f;
    f[0] = lanewise([k](double y) { return value(k, y); }, x);
    if constexpr (Order > 0) {
      const bool rational = kind == atan || kind == atanh;
      const T w = kind == asin || kind == acos || kind == atanh ? (T(1.0) - x) * (T(1.0) + x)
                  : kind == acosh                               ? (x - T(1.0)) * (x + T(1.0))
                                                                : T(1.0) + x * x;
      const T r = T(1.0) / w;
      f[1] = rational ? r : sqrt(r);
      if (kind == acos) f[1] = -f[1];
      // Leibniz' rule, n times.
      const double s = kind == asin || kind == acos || kind == atanh ? -1.0 : 1.0;
      for (std::size_t n = 0; n + 1 < Order; ++n) {
        const double d = static_cast<double>(n);
        const double c1 = rational ? 2 * d + 2 : 2 * d + 1, c0 = rational ? d * (d + 1) : d * d;
        T t = T(c1) * x * f[n + 1];
        if (n > 0) t += T(c0) * f[n];
        f[n + 2] = T(-s) * r * t;
      }
    }
    return f;
  }
};

}  // namespace function_detail

using std::acos;
using std::acosh;
using std::asin;
using std::asinh;
using std::atan;
using std::atan2;
using std::atanh;
using std::cos;
using std::cosh;
using std::exp;
using std::expm1;
using std::log;
using std::log1p;
using std::pow;
using std::sin;
using std::sinh;
using std::tan;
using std::tanh;

/// Any scalar but double (whose functions are those of <cmath>).
template <class T>
concept Composite = Differentiated<T> ||(is_base<T>&& lanes<T> > 1);

template <Differentiated X>
X sqrt(const X& x) {
  return evaluate(function_detail::Sqrt{}, x);
}
template <Composite X>
X exp(const X& x) {
  return evaluate(function_detail::Exp{}, x);
}
template <Composite X>
X log(const X& x) {
  return evaluate(function_detail::Log{}, x);
}
template <Composite X>
X expm1(const X& x) {
  return evaluate(function_detail::Expm1{}, x);
}
template <Composite X>
X log1p(const X& x) {
  return evaluate(function_detail::Log1p{}, x);
}
template <Composite X>
X sin(const X& x) {
  return evaluate(function_detail::Wave{0, 1}, x);
}
template <Composite X>
X cos(const X& x) {
  return evaluate(function_detail::Wave{1, 0}, x);
}
template <Composite X>
X tan(const X& x) {
  return evaluate(function_detail::Tangent{1}, x);
}
template <Composite X>
X sinh(const X& x) {
  return evaluate(function_detail::HyperbolicWave{false}, x);
}
template <Composite X>
X cosh(const X& x) {
  return evaluate(function_detail::HyperbolicWave{true}, x);
}
template <Composite X>
X tanh(const X& x) {
  return evaluate(function_detail::Tangent{-1}, x);
}
template <Composite X>
X asin(const X& x) {
  return evaluate(function_detail::InverseFunction{function_detail::InverseFunction::asin}, x);
}
template <Composite X>
X acos(const X& x) {
  return evaluate(function_detail::InverseFunction{function_detail::InverseFunction::acos}, x);
}
template <Composite X>
X atan(const X& x) {
  return evaluate(function_detail::InverseFunction{function_detail::InverseFunction::atan}, x);
}
template <Composite X>
X asinh(const X& x) {
  return evaluate(function_detail::InverseFunction{function_detail::InverseFunction::asinh}, x);
}
template <Composite X>
X acosh(const X& x) {
  return evaluate(function_detail::InverseFunction{function_detail::InverseFunction::acosh}, x);
}
template <Composite X>
X atanh(const X& x) {
  return evaluate(function_detail::InverseFunction{function_detail::InverseFunction::atanh}, x);
}
/// x^p for a constant p. x may be 0 where the derivatives that are asked for exist; x < 0 for whole p only.
template <Composite X>
X pow(const X& x, double p) {
  return evaluate(function_detail::Power{p}, x);
}
template <Composite X>
X pow(const X& x, int p) {
  return evaluate(function_detail::Power{static_cast<double>(p)}, x);
}
/// x^p for p that varies; x > 0.
template <Composite X>
X pow(const X& x, const X& p) {
  return exp(p * log(x));
}
/// The angle of (x, y) in (-pi, pi], with derivatives everywhere but at the origin.
template <Composite X>
X atan2(const X& y, const X& x) {
  using B = Base<X>;
  const B y0 = base(y), x0 = base(x);
  B angle;
  for (int l = 0; l < lanes<B>; ++l) set_lane(angle, l, std::atan2(lane(y0, l), lane(x0, l)));
  if constexpr (is_base<X>) {
    return angle;
  } else {
    // Turned back by the plain angle, the vector lies on the x-axis: the rest is atan of a small number with the derivatives.
    const X c = constant<X>(x0), s = constant<X>(y0);
    return constant<X>(angle) + atan((c * y - s * x) / (c * x + s * y));
  }
}

}  // namespace karcher
