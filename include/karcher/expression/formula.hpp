#pragma once
/// \file
/// Formula: an expression that has been read, before the definitions that it uses are put in. See Symbols.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "karcher/error.hpp"
#include "karcher/expression/instruction.hpp"

namespace karcher {

/// A text is no expression. what() is a full sentence.
struct FormulaError : InputError {
  FormulaError(std::size_t where, const std::string& sentence) : InputError(sentence), position(where) {}
  std::size_t position;  ///< in the text, from 0; its length for what is missing at the end
};

/// Places are the values of symbols (`of_symbol` is set, the rest is the symbol's number) and of the formula's own instructions (their positions in `code`;
/// `to` is without meaning). Branches lead to positions in `code`.
struct Formula {
  static constexpr std::uint32_t of_symbol = 0x80000000u;

  std::vector<Instruction> code;
  std::vector<std::uint32_t> symbols;  ///< variables and definitions that the text names, in increasing order
  std::uint32_t result = 0;            ///< place
};

}  // namespace karcher
