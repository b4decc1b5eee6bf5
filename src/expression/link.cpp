#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "karcher/expression/symbols.hpp"

namespace karcher {
namespace {

/// Instructions in static single assignment: the first places are those of the variables, the next those of what the instructions give, one each.
class Linker {
 public:
  explicit Linker(const Symbols& symbols) : symbols_(symbols), variables_(symbols.variables()) {}

  Program program(const Formula& formula) {
    const std::vector<std::uint32_t> needed = closure(formula);
    for (const std::uint32_t s : needed) {
      if (symbols_[s].kind != Symbols::Kind::variable) continue;
      place_of_symbol_[s] = symbols_[s].variable;
      inputs_.push_back(symbols_[s].variable);
    }
    for (const std::uint32_t s : needed) {
      if (symbols_[s].kind != Symbols::Kind::definition) continue;
      place_of_symbol_[s] = append(*symbols_[s].definition);
      definitions_.push_back({s, place_of_symbol_[s]});
    }
    const std::uint32_t result = append(formula);
    return with_few_places(result);
  }

 private:
  /// The symbols that the formula names, directly or through others, in increasing order. A definition names earlier symbols only.
  std::vector<std::uint32_t> closure(const Formula& formula) const {
    // From the last, so that what a definition names comes after it. Symbols that nothing names cost nothing.
    std::set<std::uint32_t, std::greater<>> needed(formula.symbols.begin(), formula.symbols.end());
    for (const std::uint32_t s : needed)
      if (symbols_[s].kind == Symbols::Kind::definition)
        needed.insert(symbols_[s].definition->symbols.begin(), symbols_[s].definition->symbols.end());
    return {needed.rbegin(), needed.rend()};
  }

  /// \return the place of the result
  std::uint32_t append(const Formula& formula) {
    const auto offset = static_cast<std::uint32_t>(code_.size());
    const std::uint32_t first = variables_ + offset;
    const auto place = [&](std::uint32_t p) { return p & Formula::of_symbol ? place_of_symbol_.at(p & ~Formula::of_symbol) : p + first; };
    for (Instruction i : formula.code) {
      i.to = variables_ + static_cast<std::uint32_t>(code_.size());
      if (operands(i.op) > 0) i.a = place(i.a);
      if (operands(i.op) > 1) i.b = place(i.b);
      if (operands(i.op) > 2) i.c = place(i.c);
      if (!has_result(i.op)) i.b += offset;
      code_.push_back(i);
    }
    return place(formula.result);
  }

  /// Results take over the places of values that nothing reads afterwards. This is right with branches, too, since they lead forward only.
  Program with_few_places(std::uint32_t result) {
    constexpr std::uint32_t kept = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> last_use(variables_ + code_.size(), 0);
    const auto reads = [](Instruction& i) { return std::array<std::uint32_t*, 3>{&i.a, &i.b, &i.c}; };
    for (std::size_t n = 0; n < code_.size(); ++n)
      for (int k = 0; k < operands(code_[n].op); ++k) last_use[*reads(code_[n])[static_cast<std::size_t>(k)]] = static_cast<std::uint32_t>(n);
    std::fill_n(last_use.begin(), variables_, kept);
    for (const Program::Definition& d : definitions_) last_use[d.place] = kept;
    last_use[result] = kept;

    std::vector<std::uint32_t> place(variables_ + code_.size(), 0), free;
    std::uint32_t places = variables_;
    for (std::uint32_t i = 0; i < variables_; ++i) place[i] = i;
    for (std::size_t n = 0; n < code_.size(); ++n) {
      Instruction& i = code_[n];
      for (int k = 0; k < operands(i.op); ++k) {
        std::uint32_t& p = *reads(i)[static_cast<std::size_t>(k)];
        const std::uint32_t value = p;
        p = place[value];
        if (last_use[value] != n) continue;
        free.push_back(p);
        last_use[value] = kept;  // an instruction may read it twice
      }
      if (!has_result(i.op)) continue;
      const std::uint32_t value = i.to;
      if (free.empty()) free.push_back(places++);
      i.to = place[value] = free.back();
      free.pop_back();
    }
    for (Program::Definition& d : definitions_) d.place = place[d.place];
    return Program(std::move(code_), std::move(inputs_), std::move(definitions_), places, place[result]);
  }

  const Symbols& symbols_;
  std::map<std::uint32_t, std::uint32_t> place_of_symbol_;
  std::uint32_t variables_;
  std::vector<std::uint32_t> inputs_;
  std::vector<Program::Definition> definitions_;
  std::vector<Instruction> code_;
};

}  // namespace

Program Symbols::link(const Formula& formula) const { return Linker(*this).program(formula); }

}  // namespace karcher
