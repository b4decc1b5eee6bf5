#include "expression/emitter.hpp"

#include <algorithm>
#include <optional>

#include "karcher/expression/run.hpp"

namespace karcher {
namespace {

using Kind = Operand::Kind;

/// The operation on constants, computed as programs compute it.
double fold(Op op, double a, double b = 0) {
  double r[3] = {a, b, 0};
  const Instruction i{op, 2, 0, 1};
  run(&i, &i + 1, r);
  return r[2];
}

bool is_constant(const Operand& x) { return x.kind == Kind::constant; }
/// k symbol + m
bool is_affine(const Operand& x) { return x.kind == Kind::symbol || x.kind == Kind::affine; }
bool same_symbol(const Operand& a, const Operand& b) { return is_affine(a) && is_affine(b) && a.place == b.place; }

Operand affine(std::uint32_t place, double k, double m) { return {Kind::affine, place, k, m}; }

/// a + sign b, if it is affine in one symbol.
std::optional<Operand> affine_sum(const Operand& a, const Operand& b, double sign) {
  if (!((is_affine(a) && is_constant(b)) || (is_constant(a) && is_affine(b)) || same_symbol(a, b))) return {};
  return affine(is_affine(a) ? a.place : b.place, a.k + sign * b.k, a.m + sign * b.m);
}

std::optional<Operand> affine_product(const Operand& a, const Operand& b) {
  const Operand &x = is_constant(a) ? b : a, &c = is_constant(a) ? a : b;
  if (!is_constant(c)) return {};
  // c + 0 and m = 0 also for x = symbol: the product of -0 is 0.
  if (x.kind == Kind::symbol) return affine(x.place, c.m + 0.0, 0);
  if (x.kind == Kind::affine) return affine(x.place, x.k * c.m, x.m * c.m);
  return {};
}

}  // namespace

Operand Emitter::symbol(std::uint32_t number) {
  symbols_.insert(number);
  return {Kind::symbol, number | Formula::of_symbol, 1, 0};
}

Operand Emitter::negate(const Operand& a) { return is_constant(a) ? constant(-a.m) : emit(Op::negate, place(a)); }

Operand Emitter::binary(Op op, const Operand& a, const Operand& b) {
  if (is_constant(a) && is_constant(b)) return constant(fold(op, a.m, b.m));
  switch (op) {
    case Op::add:
      if (const auto x = affine_sum(a, b, 1)) return *x;
      if (is_constant(a)) return emit(Op::add_constant, place(b), 0, a.m);
      if (is_constant(b)) return emit(Op::add_constant, place(a), 0, b.m);
      break;
    case Op::subtract:
      if (const auto x = affine_sum(a, b, -1)) return *x;
      if (is_constant(a)) return emit(Op::subtract_from_constant, place(b), 0, a.m);
      if (is_constant(b)) return emit(Op::add_constant, place(a), 0, -b.m);
      break;
    case Op::multiply:
      if (const auto x = affine_product(a, b)) return *x;
      if (is_constant(a)) return emit(Op::multiply_constant, place(b), 0, a.m);
      if (is_constant(b)) return emit(Op::multiply_constant, place(a), 0, b.m);
      break;
    case Op::divide:
      if (a.kind == Kind::affine && is_constant(b) && b.m != 0) return affine(a.place, a.k / b.m, a.m / b.m);
      if (is_constant(a)) return emit(Op::divide_constant, place(b), 0, a.m);
      if (is_constant(b)) return emit(Op::divide_by_constant, place(a), 0, b.m);
      break;
    case Op::power:
      if (!is_constant(b)) break;
      if (a.kind == Kind::symbol) {
        if (b.m == 0) return constant(1);
        if (b.m == 1) return a;
        if (b.m == 2) return emit(Op::square, a.place);
        if (b.m == 3) return emit(Op::cube, a.place);
        if (b.m == 4) return emit(Op::fourth, a.place);
      }
      return emit(Op::power_constant, place(a), 0, b.m);
    default:
      break;
  }
  const std::uint32_t left = place(a);
  return emit(op, left, place(b));
}

Operand Emitter::call(const Function& function, std::span<const Operand> arguments) {
  if (function.arguments > 0) {
    if (std::all_of(arguments.begin(), arguments.end(), is_constant))
      return constant(fold(function.op, arguments[0].m, arguments.size() > 1 ? arguments[1].m : 0));
    if (function.op == Op::power && is_constant(arguments[1])) return emit(Op::power_constant, place(arguments[0]), 0, arguments[1].m);
    const std::uint32_t first = place(arguments[0]);
    return emit(function.op, first, arguments.size() > 1 ? place(arguments[1]) : 0);
  }
  // Even of constants the result is no constant, and of one symbol it is not affine, since those combine with their neighbours, which would change bits.
  Operand r = arguments[0];
  if (function.op == Op::add)
    r = emit(Op::add_constant, place(r), 0, 0.0);
  else if (arguments.size() == 1)
    r = emit(function.op, place(r), place(r));
  for (const Operand& x : arguments.subspan(1)) {
    const std::uint32_t left = place(r);
    r = emit(function.op, left, place(x));
  }
  return function.mean ? emit(Op::divide_by_constant, place(r), 0, static_cast<double>(arguments.size())) : r;
}

Emitter::Conditional Emitter::begin(const Operand& condition) {
  Conditional x;
  x.condition = place(condition);
  x.branch = emit(Op::branch, x.condition).place;
  return x;
}

void Emitter::otherwise(Conditional& x, const Operand& yes) {
  x.yes = place(yes);
  x.otherwise = emit(Op::otherwise, x.condition).place;
  formula_.code[x.branch].b = static_cast<std::uint32_t>(formula_.code.size());
}

Operand Emitter::end(const Conditional& x, const Operand& no) {
  const std::uint32_t b = place(no);
  formula_.code[x.otherwise].b = static_cast<std::uint32_t>(formula_.code.size());
  return emit(Op::select, x.yes, b, 0, 0, x.condition);
}

Formula Emitter::finish(const Operand& result) {
  formula_.result = place(result);
  formula_.symbols.assign(symbols_.begin(), symbols_.end());
  return std::move(formula_);
}

std::uint32_t Emitter::place(const Operand& x) {
  switch (x.kind) {
    case Kind::constant:
      return emit(Op::constant, 0, 0, x.m).place;
    case Kind::affine:
      return emit(Op::affine, x.place, 0, x.k, x.m).place;
    default:
      return x.place;
  }
}

Operand Emitter::emit(Op op, std::uint32_t a, std::uint32_t b, double k, double m, std::uint32_t c) {
  const auto number = static_cast<std::uint32_t>(formula_.code.size());
  formula_.code.push_back({op, number, a, b, c, k, m});
  return {Kind::computed, number};
}

}  // namespace karcher
