#pragma once
/// \file
/// Program: an expression with all that it needs, ready to be evaluated over any scalar. Immutable, so threads may share it.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "karcher/expression/instruction.hpp"
#include "karcher/expression/run.hpp"

namespace karcher {

/// Places for n scalars, without values; few of them are on the stack.
template <class S>
class Places {
 public:
  static_assert(std::is_trivially_copyable_v<S> && std::is_trivially_destructible_v<S>);
  explicit Places(std::size_t n) {
    if (n > few) many_ = std::make_unique_for_overwrite<S[]>(n);
    data_ = n > few ? many_.get() : reinterpret_cast<S*>(small_);
  }
  Places(const Places&) = delete;
  Places& operator=(const Places&) = delete;
  S* data() { return data_; }
  S& operator[](std::size_t i) { return data_[i]; }

 private:
  static constexpr std::size_t few = sizeof(S) > 1024 ? 4 : 4096 / sizeof(S);
  alignas(S) std::byte small_[few * sizeof(S)];
  std::unique_ptr<S[]> many_;
  S* data_;
};

class Program {
 public:
  /// A definition's value, which stays at its place after an evaluation.
  struct Definition {
    std::uint32_t symbol, place;
  };

  Program() = default;
  Program(std::vector<Instruction> code, std::vector<std::uint32_t> inputs, std::vector<Definition> definitions, std::uint32_t places,
          std::uint32_t result)
      : code_(std::move(code)), inputs_(std::move(inputs)), definitions_(std::move(definitions)), places_(places), result_(result) {}

  /// \param variables all variables of the Symbols
  /// Scalars are double, Pack<W>, and Dual and Jet of them, nested as karcher/math/scalar.hpp says. Of c ? a : b, only what some lane takes is evaluated, and what
  /// a lane does not take does not reach its value or derivatives, finite or not.
  template <class S>
  S evaluate(std::span<const S> variables) const {
    Places<S> places(places_);
    for (const std::uint32_t i : inputs_) places[i] = variables[i];
    return evaluate_in(places.data());
  }
  /// The same in size() places of which the first are the variables; those of inputs() must have their values, and keep them. Afterwards, definitions() have theirs.
  template <class S>
  const S& evaluate_in(S* places) const {
    run(code_.data(), code_.data() + code_.size(), places);
    return places[result_];
  }

  std::size_t size() const { return places_; }
  /// The place of the result.
  std::uint32_t result() const { return result_; }
  /// The variables that are named, also through definitions, in increasing order.
  const std::vector<std::uint32_t>& inputs() const { return inputs_; }
  /// The definitions that are needed; each uses earlier ones only.
  const std::vector<Definition>& definitions() const { return definitions_; }
  const std::vector<Instruction>& code() const { return code_; }

 private:
  std::vector<Instruction> code_;
  std::vector<std::uint32_t> inputs_;
  std::vector<Definition> definitions_;
  std::uint32_t places_ = 1, result_ = 0;
};

}  // namespace karcher
