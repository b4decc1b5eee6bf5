#include "karcher/expression/tape.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>

namespace karcher {
namespace {

using T = NativeScalar;

bool is_step_function(Op op) {
  switch (op) {
    case Op::constant:
    case Op::less:
    case Op::greater:
    case Op::less_equal:
    case Op::greater_equal:
    case Op::equal:
    case Op::not_equal:
    case Op::conjunction:
    case Op::disjunction:
    case Op::sign:
    case Op::rint:
    case Op::floor:
    case Op::ceil:
      return true;
    default:
      return false;
  }
}

struct Slopes {
  double a, b;
};
/// Of an operation that is linear in a and b.
std::optional<Slopes> slopes(const Instruction& i) {
  switch (i.op) {
    case Op::add:
      return Slopes{1, 1};
    case Op::subtract:
      return Slopes{1, -1};
    case Op::negate:
    case Op::subtract_from_constant:
      return Slopes{-1, 0};
    case Op::add_constant:
      return Slopes{1, 0};
    case Op::affine:
    case Op::multiply_constant:
      return Slopes{i.k, 0};
    case Op::divide_by_constant:
      return Slopes{1 / i.k, 0};
    default:
      return {};
  }
}

}  // namespace

Tape::Tape(const Program& program, const std::vector<std::vector<std::uint32_t>>& depends_on, std::size_t coordinates)
    : variables_(depends_on.size()), coordinates_(coordinates) {
  // The value that stands at a place when an instruction reads it is the last that the code before wrote there: branches lead forward only.
  std::vector<std::uint32_t> value(std::max(program.size(), variables_));
  std::iota(value.begin(), value.end(), 0);
  std::vector<std::vector<std::uint32_t>> on = depends_on;
  on.resize(variables_ + program.code().size());
  for (const Instruction& code : program.code()) {
    const auto own = static_cast<std::uint32_t>(variables_ + steps_.size());
    Step& s = steps_.emplace_back();
    s.instruction = code;
    Instruction& i = s.instruction;
    const int count = operands(i.op);
    if (count > 0) i.a = value[i.a];
    if (count > 1) i.b = value[i.b];
    if (count > 2) i.c = value[i.c];
    i.to = own;
    if (!has_result(i.op)) {
      s.kind = Kind::jump;
      branches_ = true;
      continue;
    }
    value[code.to] = own;
    if (is_step_function(i.op)) continue;
    if (count > 0) s.on_a = on[i.a];
    if (count > 1) s.on_b = on[i.b];
    s.a = !s.on_a.empty();
    s.b = !s.on_b.empty();
    if (!s.a && !s.b) continue;
    std::set_union(s.on_a.begin(), s.on_a.end(), s.on_b.begin(), s.on_b.end(), std::back_inserter(s.on));
    on[own] = s.on;
    const auto linear = slopes(i);
    s.kind = linear                 ? Kind::linear
             : i.op == Op::multiply ? Kind::product
             : i.op == Op::square   ? Kind::square
             : i.op == Op::select   ? Kind::select
                                    : Kind::curved;
    if (linear) s.by_a = linear->a, s.by_b = linear->b;
  }
  result_ = value[program.result()];
}

TapeRun::TapeRun(const Tape& tape)
    : tape_(&tape),
      values_(tape.variables_ + tape.steps_.size(), T(0.0)),
      adjoints_(values_.size()),
      rows_(values_.size() * tape.coordinates_, T(0.0)),
      reached_(tape.branches_ ? values_.size() : 0),
      partials_(tape.steps_.size()) {
  taken_.reserve(tape.steps_.size());
}

T TapeRun::value() {
  const std::vector<Tape::Step>& steps = tape_->steps_;
  T* v = values_.data();
  taken_.clear();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Tape::Step& s = steps[k];
    const Instruction& i = s.instruction;
    if (s.kind == Tape::Kind::jump) {
      const auto m = run_detail::truth(v[i.a]);
      if (i.op == Op::branch ? !any(m) : all(m)) k = i.b - std::size_t{1};
      continue;
    }
    taken_.push_back(static_cast<std::uint32_t>(k));
    if (s.kind == Tape::Kind::curved)
      differentiate(s, partials_[k]);
    else
      v[i.to] = run_detail::result(i, v);
  }
  return v[tape_->result_];
}

/// Value and partial derivatives by a and b of what is neither linear nor a product.
void TapeRun::differentiate(const Tape::Step& s, Partials& p) {
  using J = Jet<T, 2>;
  const Instruction& i = s.instruction;
  J operand[3];
  operand[0] = s.a ? J::variable(values_[i.a], 0) : constant<J>(values_[i.a]);
  if (operands(i.op) > 1) operand[1] = s.b ? J::variable(values_[i.b], 1) : constant<J>(values_[i.b]);
  const J r = run_detail::result(Instruction{i.op, 2, 0, 1, 2, i.k, i.m}, operand);
  values_[i.to] = r.v;
  p = {r.g[0], r.g[1], r.h[0], r.h[1], r.h[2]};
}

/// Where a lane does not take what uses the value, its derivatives count for nothing, finite or not.
void TapeRun::stop_at_lanes_not_reached(const Tape::Step& s, Partials& p) {
  const auto here = reached_[s.instruction.to] > T(0.0);
  for (T* x : {&p.a, &p.b, &p.aa, &p.ab, &p.bb}) *x = select(here, *x, T(0.0));
  if (s.a) reached_[s.instruction.a] = max(reached_[s.instruction.a], reached_[s.instruction.to]);
  if (s.b) reached_[s.instruction.b] = max(reached_[s.instruction.b], reached_[s.instruction.to]);
}

const T* TapeRun::adjoints(const T& seed) {
  const T* v = values_.data();
  T* l = adjoints_.data();
  std::fill(adjoints_.begin(), adjoints_.end(), T(0.0));
  std::fill(reached_.begin(), reached_.end(), T(0.0));
  l[tape_->result_] = seed;
  if (tape_->branches_) reached_[tape_->result_] = T(1.0);
  for (auto k = taken_.rbegin(); k != taken_.rend(); ++k) {
    const Tape::Step& s = tape_->steps_[*k];
    const Instruction& i = s.instruction;
    Partials& p = partials_[*k];
    switch (s.kind) {
      case Tape::Kind::jump:
      case Tape::Kind::passive:
        continue;
      case Tape::Kind::select: {
        const auto m = run_detail::truth(v[i.c]);
        const T here = reached_[i.to];  // a program with a choice has branches
        if (s.a) l[i.a] += select(m, l[i.to], T(0.0)), reached_[i.a] = max(reached_[i.a], select(m, here, T(0.0)));
        if (s.b) l[i.b] += select(m, T(0.0), l[i.to]), reached_[i.b] = max(reached_[i.b], select(m, T(0.0), here));
        continue;
      }
      case Tape::Kind::linear:
        p = {T(s.by_a), T(s.by_b), T(0.0), T(0.0), T(0.0)};
        break;
      case Tape::Kind::product:
        p = {v[i.b], v[i.a], T(0.0), T(1.0), T(0.0)};
        break;
      case Tape::Kind::square:
        p = {T(2.0) * v[i.a], T(0.0), T(2.0), T(0.0), T(0.0)};
        break;
      case Tape::Kind::curved:
        break;
    }
    if (tape_->branches_) stop_at_lanes_not_reached(s, p);
    if (s.a) l[i.a] += l[i.to] * p.a;
    if (s.b) l[i.b] += l[i.to] * p.b;
  }
  return l;
}

void TapeRun::add_curvature(T* h) {
  const std::size_t n = tape_->coordinates_;
  const auto row = [&](std::uint32_t value) { return rows_.data() + value * n; };
  const auto add_outer = [&](const T& c, const T* g, const std::vector<std::uint32_t>& on) {
    for (std::size_t x = 0; x < on.size(); ++x) {
      const T cg = c * g[on[x]];
      for (std::size_t y = x; y < on.size(); ++y) h[on[x] * n + on[y]] += cg * g[on[y]];
    }
  };
  for (const std::uint32_t k : taken_) {
    const Tape::Step& s = tape_->steps_[k];
    const Instruction& i = s.instruction;
    if (s.kind == Tape::Kind::passive) continue;
    const Partials& p = partials_[k];
    const T *a = row(i.a), *b = s.b ? row(i.b) : a;
    T* r = row(i.to);
    if (s.kind == Tape::Kind::select) {
      const auto m = run_detail::truth(values_[i.c]);
      for (const std::uint32_t y : s.on) r[y] = select(m, s.a ? a[y] : T(0.0), s.b ? b[y] : T(0.0));
      continue;
    }
    if (s.a && s.b)
      for (const std::uint32_t y : s.on) r[y] = p.a * a[y] + p.b * b[y];
    else if (s.a)
      for (const std::uint32_t y : s.on) r[y] = p.a * a[y];
    else
      for (const std::uint32_t y : s.on) r[y] = p.b * b[y];
    if (s.kind == Tape::Kind::linear) continue;
    const T l = adjoints_[i.to];
    if (s.a && s.kind != Tape::Kind::product) add_outer(l * p.aa, a, s.on_a);
    if (s.b && s.kind == Tape::Kind::curved) add_outer(l * p.bb, b, s.on_b);
    if (!s.a || !s.b) continue;
    const T mixed = l * p.ab;
    for (const std::uint32_t x : s.on_a) {
      const T ca = mixed * a[x];
      for (const std::uint32_t y : s.on_b) {
        const T c = ca * b[y];
        h[std::min(x, y) * n + std::max(x, y)] += x == y ? c + c : c;
      }
    }
  }
}

}  // namespace karcher
