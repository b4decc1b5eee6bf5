#pragma once
/// \file
/// Counted: a double that counts the operations done with it, to say how many a kernel needs.

#include <cmath>

#include "karcher/math/scalar.hpp"

namespace karcher {

struct Counted {
  double v = 0;
  static inline long additions = 0, multiplications = 0, divisions = 0, roots = 0;
  static long operations() { return additions + multiplications + divisions + roots; }
  static void reset() { additions = multiplications = divisions = roots = 0; }

  Counted() = default;
  Counted(double x) : v(x) {}
  Counted(int x) : v(x) {}
  Counted& operator+=(Counted b) {
    ++additions;
    v += b.v;
    return *this;
  }
  Counted& operator-=(Counted b) {
    ++additions;
    v -= b.v;
    return *this;
  }
  Counted& operator*=(Counted b) {
    ++multiplications;
    v *= b.v;
    return *this;
  }
  friend Counted operator+(Counted a, Counted b) { return a += b; }
  friend Counted operator-(Counted a, Counted b) { return a -= b; }
  friend Counted operator*(Counted a, Counted b) { return a *= b; }
  friend Counted operator/(Counted a, Counted b) {
    ++divisions;
    return Counted(a.v / b.v);
  }
  friend Counted operator-(Counted a) { return Counted(-a.v); }
  friend bool operator<(Counted a, Counted b) { return a.v < b.v; }
  friend bool operator>(Counted a, Counted b) { return a.v > b.v; }
};
inline Counted sqrt(Counted a) {
  ++Counted::roots;
  return Counted(std::sqrt(a.v));
}
inline Counted select(bool m, Counted a, Counted b) { return m ? a : b; }
inline Counted max(Counted a, Counted b) { return a.v < b.v ? b : a; }
inline Counted min(Counted a, Counted b) { return b.v < a.v ? b : a; }
inline double lane(Counted a, int) { return a.v; }
inline void set_lane(Counted& a, int, double x) { a.v = x; }

}  // namespace karcher
