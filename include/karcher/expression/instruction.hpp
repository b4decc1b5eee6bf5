#pragma once
/// \file
/// What a compiled expression is made of: a flat list of instructions on numbered places. The list is run from front to back; branches lead forward only.

#include <cstddef>
#include <cstdint>

namespace karcher {

/// `a`, `b`, `c` are values at the places of an Instruction, `k`, `m` its constants. Truth is 1 or 0; what is not 0 is true.
enum class Op : std::uint8_t {
  constant,  ///< k
  affine,    ///< k a + m
  square,    ///< a a
  cube,      ///< (a a) a
  fourth,    ///< ((a a) a) a
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,                   ///< a^b
  add_constant,            ///< a + k
  subtract_from_constant,  ///< k - a
  multiply_constant,       ///< k a
  divide_by_constant,      ///< a / k
  divide_constant,         ///< k / a
  power_constant,          ///< a^k
  less,
  greater,
  less_equal,
  greater_equal,
  equal,
  not_equal,
  conjunction,
  disjunction,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,
  log,
  log2,
  log10,
  exp,
  sqrt,
  abs,
  sign,
  rint,  ///< floor(a + 1/2)
  floor,
  ceil,
  modulo,  ///< a - b floor(a/b)
  min,
  max,
  select,     ///< c ? a : b, lane by lane
  branch,     ///< to the instruction b where a is true in no lane
  otherwise,  ///< to the instruction b where a is true in every lane
};

struct Instruction {
  Op op = Op::constant;
  std::uint32_t to = 0;  ///< the place of the result; branch and otherwise have none
  std::uint32_t a = 0, b = 0, c = 0;
  double k = 0, m = 0;
};

/// The places a, b and c (in this order) are read by so many first of them; `b` of branch and otherwise is no place.
constexpr int operands(Op op) {
  switch (op) {
    case Op::constant:
      return 0;
    case Op::add:
    case Op::subtract:
    case Op::multiply:
    case Op::divide:
    case Op::power:
    case Op::less:
    case Op::greater:
    case Op::less_equal:
    case Op::greater_equal:
    case Op::equal:
    case Op::not_equal:
    case Op::conjunction:
    case Op::disjunction:
    case Op::atan2:
    case Op::modulo:
    case Op::min:
    case Op::max:
      return 2;
    case Op::select:
      return 3;
    default:
      return 1;
  }
}
constexpr bool has_result(Op op) { return op < Op::branch; }

}  // namespace karcher
