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
  /// An instruction on numbered values: first the variables, then what the instructions give.
  struct Step {
    Instruction instruction;
    Kind kind = Kind::passive;
    bool a = false, b = false;                  ///< whether these operands depend on y
    double by_a = 0, by_b = 0;                  ///< of linear
    std::vector<std::uint32_t> on, on_a, on_b;  ///< y that the result and the operands depend on
  };

  std::vector<Step> steps_;
  std::size_t variables_, coordinates_;
  std::uint32_t result_ = 0;
  bool branches_ = false;
};

/// The numbers of a Tape at one point after another.
class TapeRun {
 public:
  using T = NativeScalar;
  explicit TapeRun(const Tape& tape);

  /// The variables: values to be set before value(), ...
  T* values() { return values_.data(); }
  /// ... their derivatives by all y to be set before add_curvature(), variable after variable. Those on which a variable does not depend stay 0.
  T* rows() { return rows_.data(); }

  /// The program's value at the variables.
  T value();
  /// seed times the derivatives of the value by the variables, in their order; after value().
  const T* adjoints(const T& seed);
  /// Adds to the upper triangle of the matrix h, coordinates x coordinates, seed times the second derivatives of the value as far as those of the variables vanish;
  /// after adjoints().
  void add_curvature(T* h);

 private:
  struct Partials {
    T a, b, aa, ab, bb;
  };
  void differentiate(const Tape::Step& step, Partials& p);
  void stop_at_lanes_not_reached(const Tape::Step& step, Partials& p);

  const Tape* tape_;
  std::vector<T> values_, adjoints_, rows_, reached_;
  std::vector<Partials> partials_;
  std::vector<std::uint32_t> taken_;  ///< the steps that gave a value
};

}  // namespace karcher
