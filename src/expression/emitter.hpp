#pragma once
/// \file
/// Emitter: writes the instructions of one formula, operation by operation, and computes with constants meanwhile (see Symbols).

#include <cstdint>
#include <set>
#include <span>

#include "expression/function.hpp"
#include "karcher/expression/formula.hpp"

namespace karcher {

/// A value that instructions may have been written for.
struct Operand {
  enum class Kind {
    constant,  ///< m
    symbol,    ///< the symbol `place`; k = 1, m = 0
    affine,    ///< k symbol + m
    computed   ///< by the instruction `place`
  } kind;
  std::uint32_t place = 0;
  double k = 0, m = 0;
};

class Emitter {
 public:
  static Operand constant(double value) { return {Operand::Kind::constant, 0, 0, value}; }
  Operand symbol(std::uint32_t number);
  Operand negate(const Operand& a);
  /// \param op add to disjunction
  Operand binary(Op op, const Operand& a, const Operand& b);
  Operand call(const Function& function, std::span<const Operand> arguments);

  /// condition ? yes : no, in the order of the text: x = begin(condition), what gives yes, otherwise(x, yes), what gives no, end(x, no).
  struct Conditional {
    std::uint32_t condition = 0, branch = 0, yes = 0, otherwise = 0;
  };
  Conditional begin(const Operand& condition);
  void otherwise(Conditional& conditional, const Operand& yes);
  Operand end(const Conditional& conditional, const Operand& no);

  Formula finish(const Operand& result);

 private:
  std::uint32_t place(const Operand& x);
  Operand emit(Op op, std::uint32_t a = 0, std::uint32_t b = 0, double k = 0, double m = 0, std::uint32_t c = 0);

  Formula formula_;
  std::set<std::uint32_t> symbols_;
};

}  // namespace karcher
