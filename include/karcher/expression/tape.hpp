#pragma once
/// \file
/// Tape: a Program with the exact gradient and Hessian of its value in coordinates y that its variables depend on, over packs.
///
/// With v_k = f_k(v_a, v_b) for the instruction k, l = dW/dv and the rows G = dv/dy,
///   backwards  l_a += l_k f_k,a,      forwards  G_k = f_k,a G_a + f_k,b G_b,   H += l_k (f_k,aa G_a G_a^T + f_k,ab (G_a G_b^T + G_b G_a^T) + f_k,bb G_b G_b^T),
/// so a Hessian costs one sweep of first derivatives and rank-one updates where something is not linear (Griewank, Walther, "Evaluating derivatives", 2008, chapter 5).
/// f_k,a, ... are those of the jets that run.hpp would compute with. What a lane does not take of c ? a : b reaches no derivative.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "karcher/expression/program.hpp"
#include "karcher/math/aligned.hpp"
#include "karcher/math/pack.hpp"

namespace karcher {

/// Immutable, so threads may share it; numbers are in a TapeRun.
class Tape {
 public:
  /// \param depends_on  for every variable of the program, in their order: the coordinates y that it depends on, increasing; of data none
  Tape(const Program& program, const std::vector<std::vector<std::uint32_t>>& depends_on, std::size_t coordinates);

  std::size_t coordinates() const { return coordinates_; }
  std::size_t variables() const { return variables_; }

 private:
  friend class TapeRun;
  enum class Kind : std::uint8_t {
    jump,     ///< branch, otherwise
    passive,  ///< no operand depends on y, or the result is a step function
    linear,   ///< partial derivatives k (by a) and m (by b) that are the same everywhere
    product,
    square,
    select,
    curved  ///< partial derivatives by jets
  };
  /// y from `begin` up to `end`.
  struct Run {
    std::uint32_t begin, end;
  };
  /// An instruction on numbered values: first the variables, then what the instructions give.
  struct Step {
    Instruction instruction;
    Kind kind = Kind::passive;
    bool a = false, b = false;  ///< whether these operands depend on y
    bool row = false;           ///< whether something that is not linear depends on the result, so that its row is needed
    std::uint32_t row_a = 0, row_b = 0, row_to = 0;
    std::uint32_t partials = 0;       ///< of curved: where they are kept
    double by_a = 0, by_b = 0;        ///< of linear
    std::vector<Run> on, on_a, on_b;  ///< y that the result and the operands depend on
  };

  static std::vector<Run> runs(const std::vector<std::uint32_t>& coordinates);

  std::vector<Step> steps_;
  std::size_t variables_, coordinates_;
  std::size_t rows_, curved_ = 0;  ///< how many there are
  std::uint32_t result_ = 0;
  bool branches_ = false;
  bool mixed_ = false;  ///< whether something that is not linear has two operands that depend on y
};

/// The numbers of a Tape at one point after another.
class TapeRun {
 public:
  using T = NativeScalar;
  explicit TapeRun(const Tape& tape);

  /// The variables: values to be set before value(), ...
  T* values() { return values_.data(); }
  /// ... their derivatives by all y to be set before curvature(), variable after variable. Those on which a variable does not depend stay 0.
  T* rows() { return rows_.data(); }

  /// The program's value at the variables.
  T value();
  /// seed times the derivatives of the value by the variables, in their order; after value().
  const T* adjoints(const T& seed);
  /// The upper triangle of the matrix h, coordinates x coordinates: seed times the second derivatives of the value as far as those of the variables vanish; after
  /// adjoints().
  void curvature(T* h);

 private:
  struct Partials {
    T a, b, aa, ab, bb;
  };
  void differentiate(const Tape::Step& step, Partials& p);
  /// Of what is not linear. Where a lane does not take what uses the value, its derivatives count for nothing, finite or not.
  Partials partials(const Tape::Step& step) const;

  const Tape* tape_;
  std::vector<T> values_, adjoints_, rows_, reached_, mixed_;
  std::vector<Partials> partials_;
  std::vector<std::uint32_t> taken_;  ///< the steps that gave a value
};

}  // namespace karcher
