#pragma once
/// \file
/// Runs instructions over any scalar. Values over double are those of muParser, bit by bit (see Symbols); over other scalars they agree to rounding.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <type_traits>

#include "karcher/expression/instruction.hpp"
#include "karcher/math/functions.hpp"

namespace karcher {

namespace run_detail {

template <class S>
inline constexpr bool is_double = std::is_same_v<S, double>;

template <class S>
MaskOf<S> equal(const S& a, const S& b) {
  return (base(a) <= base(b)) & (base(a) >= base(b));
}
/// NaN is true, as in C.
template <class S>
MaskOf<S> truth(const S& a) {
  return !equal(base(a), Base<S>(0.0));
}
template <class S>
S number(const MaskOf<S>& m) {
  return constant<S>(select(m, Base<S>(1.0), Base<S>(0.0)));
}
/// A function whose derivatives vanish.
template <class S, class F>
S step(const F& f, const S& a) {
  return constant<S>(function_detail::lanewise(f, base(a)));
}
template <class S, class F>
Base<S> lanewise(const F& f, const S& a, const S& b) {
  Base<S> r;
  for (int l = 0; l < lanes<S>; ++l) set_lane(r, l, f(lane(base(a), l), lane(base(b), l)));
  return r;
}

inline double sign(double a) { return a < 0 ? -1.0 : a > 0 ? 1.0 : 0.0; }

// muParser's formulas for double; elsewhere the functions that are accurate everywhere.
template <class S>
S asinh(const S& a) {
  if constexpr (is_double<S>)
    return std::log(a + std::sqrt(a * a + 1));
  else
    return karcher::asinh(a);
}
template <class S>
S acosh(const S& a) {
  if constexpr (is_double<S>)
    return std::log(a + std::sqrt(a * a - 1));
  else
    return karcher::acosh(a);
}
template <class S>
S atanh(const S& a) {
  if constexpr (is_double<S>)
    return 0.5 * std::log((1 + a) / (1 - a));
  else
    return karcher::atanh(a);
}
template <class S>
S log2(const S& a) {
  return log(a) / std::numbers::ln2;
}
template <class S>
S log10(const S& a) {
  if constexpr (is_double<S>)
    return std::log10(a);
  else
    return log(a) / std::numbers::ln10;
}
/// -0 stays -0.
template <class S>
S abs(const S& a) {
  return select(base(a) < Base<S>(0.0), -a, a);
}
template <class S>
S modulo(const S& a, const S& b) {
  // One rounding, where a and b floor(a/b) nearly cancel.
  if constexpr (is_double<S>)
    return std::fma(-b, std::floor(a / b), a);
  else
    return a - scaled(b, lanewise([](double x, double y) { return std::floor(x / y); }, a, b));
}

/// x^p with an exponent per lane, as function_detail::Power.
template <class B>
struct Power {
  B exponent;
  template <int Order, class T>
  std::array<T, static_cast<std::size_t>(Order + 1)> derivatives(const T& x) const {
    std::array<T, static_cast<std::size_t>(Order + 1)> f;
    T factor = T(1.0), e = exponent;
    for (std::size_t n = 0; n <= Order; ++n) {
      f[n] = select(equal(factor, T(0.0)), T(0.0), factor * lanewise([](double y, double p) { return std::pow(y, p); }, x, e));
      factor *= e;
      e -= T(1.0);
    }
    return f;
  }
};

/// Where all derivatives of x vanish.
template <class S>
MaskOf<S> is_constant(const S& x) {
  if constexpr (is_base<S>) {
    return !(x < x);  // always
  } else if constexpr (requires { x.g; }) {
    MaskOf<S> m = is_constant(x.v);
    for (const auto& g : x.g) m = m & equal(g, Base<S>(0.0));
    for (const auto& h : x.h) m = m & equal(h, Base<S>(0.0));
    return m;
  } else {
    MaskOf<S> m = is_constant(x.v);
    for (const auto& d : x.d) m = m & is_constant(d) & equal(base(d), Base<S>(0.0));
    return m;
  }
}

/// a^b. Where b has no derivatives, a may be 0 or less as for a constant exponent; elsewhere the derivatives are those of exp(b log a).
template <class S>
S power(const S& a, const S& b) {
  if constexpr (is_base<S>) {
    return lanewise([](double x, double y) { return std::pow(x, y); }, a, b);
  } else {
    const MaskOf<S> m = is_constant(b);
    const S fixed = karcher::evaluate(Power<Base<S>>{base(b)}, a);
    if (all(m)) return fixed;
    S r = select(m, fixed, S(exp(b * log(a))));
    set_value(r, base(fixed));
    return r;
  }
}
template <class S>
S power_constant(const S& a, double k) {
  if constexpr (is_double<S>) {
    return std::pow(a, k);
  } else {
    // std::pow lane by lane would take longer than all else.
    constexpr int width = lanes<S>;
    if (width > 1 && k == 2) return a * a;
    if (width > 1 && k == 3) return a * a * a;
    if (width > 1 && k == 4) return (a * a) * (a * a);
    return pow(a, k);
  }
}

/// m ? a : b; what no lane takes has no value.
template <class S>
S choose(const MaskOf<S>& m, const S& a, const S& b) {
  return all(m) ? a : any(m) ? select(m, a, b) : b;
}

/// What an instruction gives.
template <class S>
[[gnu::always_inline]] inline S result(const Instruction& i, const S* r) {
  switch (i.op) {
    case Op::constant:
      return constant<S>(Base<S>(i.k));
    case Op::affine:
      return r[i.a] * i.k + i.m;
    case Op::square:
      return r[i.a] * r[i.a];
    case Op::cube:
      return r[i.a] * r[i.a] * r[i.a];
    case Op::fourth:
      return r[i.a] * r[i.a] * r[i.a] * r[i.a];
    case Op::negate:
      return -r[i.a];
    case Op::add:
      return r[i.a] + r[i.b];
    case Op::subtract:
      return r[i.a] - r[i.b];
    case Op::multiply:
      return r[i.a] * r[i.b];
    case Op::divide:
      return r[i.a] / r[i.b];
    case Op::power:
      return power(r[i.a], r[i.b]);
    case Op::add_constant:
      return r[i.a] + i.k;
    case Op::subtract_from_constant:
      return i.k - r[i.a];
    case Op::multiply_constant:
      return r[i.a] * i.k;
    case Op::divide_by_constant:
      return r[i.a] / i.k;
    case Op::divide_constant:
      return i.k / r[i.a];
    case Op::power_constant:
      return power_constant(r[i.a], i.k);
    case Op::less:
      return number<S>(base(r[i.a]) < base(r[i.b]));
    case Op::greater:
      return number<S>(base(r[i.a]) > base(r[i.b]));
    case Op::less_equal:
      return number<S>(base(r[i.a]) <= base(r[i.b]));
    case Op::greater_equal:
      return number<S>(base(r[i.a]) >= base(r[i.b]));
    case Op::equal:
      return number<S>(equal(r[i.a], r[i.b]));
    case Op::not_equal:
      return number<S>(!equal(r[i.a], r[i.b]));
    case Op::conjunction:
      return number<S>(truth(r[i.a]) & truth(r[i.b]));
    case Op::disjunction:
      return number<S>(truth(r[i.a]) | truth(r[i.b]));
    case Op::sin:
      return sin(r[i.a]);
    case Op::cos:
      return cos(r[i.a]);
    case Op::tan:
      return tan(r[i.a]);
    case Op::asin:
      return asin(r[i.a]);
    case Op::acos:
      return acos(r[i.a]);
    case Op::atan:
      return atan(r[i.a]);
    case Op::atan2:
      return atan2(r[i.a], r[i.b]);
    case Op::sinh:
      return sinh(r[i.a]);
    case Op::cosh:
      return cosh(r[i.a]);
    case Op::tanh:
      return tanh(r[i.a]);
    case Op::asinh:
      return asinh(r[i.a]);
    case Op::acosh:
      return acosh(r[i.a]);
    case Op::atanh:
      return atanh(r[i.a]);
    case Op::log:
      return log(r[i.a]);
    case Op::log2:
      return log2(r[i.a]);
    case Op::log10:
      return log10(r[i.a]);
    case Op::exp:
      return exp(r[i.a]);
    case Op::sqrt:
      return sqrt(r[i.a]);
    case Op::abs:
      return abs(r[i.a]);
    case Op::sign:
      return step([](double x) { return sign(x); }, r[i.a]);
    case Op::rint:
      return step([](double x) { return std::floor(x + 0.5); }, r[i.a]);
    case Op::floor:
      return step([](double x) { return std::floor(x); }, r[i.a]);
    case Op::ceil:
      return step([](double x) { return std::ceil(x); }, r[i.a]);
    case Op::modulo:
      return modulo(r[i.a], r[i.b]);
    case Op::min:
      return min(r[i.a], r[i.b]);
    case Op::max:
      return max(r[i.a], r[i.b]);
    case Op::select:
      return choose(truth(r[i.c]), r[i.a], r[i.b]);
    case Op::branch:
    case Op::otherwise:
      break;
  }
  return {};
}

}  // namespace run_detail

/// Runs the instructions from `first` up to `last`. \param r the values at all places that they name
template <class S>
void run(const Instruction* first, const Instruction* last, S* r) {
  for (const Instruction* i = first; i != last; ++i) {
    if (has_result(i->op)) [[likely]] {
      r[i->to] = run_detail::result(*i, r);
    } else {
      const auto m = run_detail::truth(r[i->a]);
      if (i->op == Op::branch ? !any(m) : all(m)) i = first + i->b - 1;
    }
  }
}

/// Compiled without fused multiply-adds, which would change bits.
extern template void run<double>(const Instruction* first, const Instruction* last, double* r);

}  // namespace karcher
