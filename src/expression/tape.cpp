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

std::vector<Tape::Run> Tape::runs(const std::vector<std::uint32_t>& coordinates) {
  std::vector<Run> list;
  for (const std::uint32_t y : coordinates) {
    if (list.empty() || list.back().end != y) list.push_back({y, y});
    ++list.back().end;
  }
  return list;
}

Tape::Tape(const Program& program, const std::vector<std::vector<std::uint32_t>>& depends_on, std::size_t coordinates)
    : variables_(depends_on.size()), coordinates_(coordinates), rows_(variables_) {
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
    s.a = count > 0 && !on[i.a].empty();
    s.b = count > 1 && !on[i.b].empty();
    if (!s.a && !s.b) continue;
    if (s.a) s.on_a = runs(on[i.a]);
    if (s.b) s.on_b = runs(on[i.b]);
    const auto &first = s.a ? on[i.a] : on[i.b], &second = s.b ? on[i.b] : first;
    std::set_union(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(on[own]));
    s.on = runs(on[own]);
    const auto linear = slopes(i);
    s.kind = linear                 ? Kind::linear
             : i.op == Op::multiply ? Kind::product
             : i.op == Op::square   ? Kind::square
             : i.op == Op::select   ? Kind::select
                                    : Kind::curved;
    if (linear) s.by_a = linear->a, s.by_b = linear->b;
    if (s.a && s.b && !linear && s.kind != Kind::select) mixed_ = true;
    if (s.kind == Kind::curved) s.partials = static_cast<std::uint32_t>(curved_++);
  }
  result_ = value[program.result()];

  std::vector<bool> needed(on.size(), false);
  for (auto s = steps_.rbegin(); s != steps_.rend(); ++s) {
    if (s->kind == Kind::jump || s->kind == Kind::passive) continue;
    const Instruction& i = s->instruction;
    s->row = needed[i.to];
    const bool operands_too = s->row || (s->kind != Kind::linear && s->kind != Kind::select);
    if (s->a && operands_too) needed[i.a] = true;
    if (s->b && operands_too) needed[i.b] = true;
  }
  std::vector<std::uint32_t> row(on.size());
  std::iota(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(variables_), 0);
  for (Step& s : steps_) {
    if (s.a) s.row_a = row[s.instruction.a];
    if (s.b) s.row_b = row[s.instruction.b];
    if (s.row) s.row_to = row[s.instruction.to] = static_cast<std::uint32_t>(rows_++);
  }
}

TapeRun::TapeRun(const Tape& tape)
    : tape_(&tape),
      values_(tape.variables_ + tape.steps_.size(), T(0.0)),
      adjoints_(values_.size()),
      rows_(tape.rows_ * tape.coordinates_, T(0.0)),
      reached_(tape.branches_ ? values_.size() : 0),
      mixed_(tape.mixed_ ? tape.coordinates_ * tape.coordinates_ : 0),
      partials_(tape.curved_) {
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
      differentiate(s, partials_[s.partials]);
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

inline TapeRun::Partials TapeRun::partials(const Tape::Step& s) const {
  const T* v = values_.data();
  const Instruction& i = s.instruction;
  Partials p = s.kind == Tape::Kind::product  ? Partials{v[i.b], v[i.a], T(0.0), T(1.0), T(0.0)}
               : s.kind == Tape::Kind::square ? Partials{T(2.0) * v[i.a], T(0.0), T(2.0), T(0.0), T(0.0)}
                                              : partials_[s.partials];
  if (tape_->branches_) {
    const auto here = reached_[i.to] > T(0.0);
    for (T* x : {&p.a, &p.b, &p.aa, &p.ab, &p.bb}) *x = select(here, *x, T(0.0));
  }
  return p;
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
    const T& own = l[i.to];
    if (s.kind == Tape::Kind::passive) continue;
    if (s.kind == Tape::Kind::select) {
      const auto m = run_detail::truth(v[i.c]);
      const T here = reached_[i.to];  // a program with a choice has branches
      if (s.a) l[i.a] += select(m, own, T(0.0)), reached_[i.a] = max(reached_[i.a], select(m, here, T(0.0)));
      if (s.b) l[i.b] += select(m, T(0.0), own), reached_[i.b] = max(reached_[i.b], select(m, T(0.0), here));
      continue;
    }
    if (s.kind == Tape::Kind::linear) {
      if (s.a) l[i.a] += own * T(s.by_a);
      if (s.b) l[i.b] += own * T(s.by_b);
    } else {
      const Partials p = partials(s);
      if (s.a) l[i.a] += own * p.a;
      if (s.b) l[i.b] += own * p.b;
    }
    if (tape_->branches_) {
      if (s.a) reached_[i.a] = max(reached_[i.a], reached_[i.to]);
      if (s.b) reached_[i.b] = max(reached_[i.b], reached_[i.to]);
    }
  }
  return l;
}

void TapeRun::curvature(T* h) {
  const std::size_t n = tape_->coordinates_;
  const auto row = [&](std::uint32_t number) { return rows_.data() + number * n; };
  std::fill_n(h, n * n, T(0.0));
  std::fill(mixed_.begin(), mixed_.end(), T(0.0));
  const auto add_square = [&](const T& c, const T* g, const std::vector<Tape::Run>& on) {
    for (auto r = on.begin(); r != on.end(); ++r)
      for (std::uint32_t x = r->begin; x < r->end; ++x) {
        const T cg = c * g[x];
        T* to = h + x * n;
        for (std::uint32_t y = x; y < r->end; ++y) to[y] += cg * g[y];
        for (auto later = r + 1; later != on.end(); ++later)
          for (std::uint32_t y = later->begin; y < later->end; ++y) to[y] += cg * g[y];
      }
  };
  const auto set_row = [](T* r, const std::vector<Tape::Run>& on, const auto& f) {
    for (const Tape::Run& x : on)
      for (std::uint32_t y = x.begin; y < x.end; ++y) r[y] = f(y);
  };
  for (const std::uint32_t k : taken_) {
    const Tape::Step& s = tape_->steps_[k];
    if (s.kind == Tape::Kind::passive) continue;
    const T *a = row(s.row_a), *b = row(s.row_b);
    T* r = row(s.row_to);
    if (s.kind == Tape::Kind::select) {
      const auto m = run_detail::truth(values_[s.instruction.c]);
      if (s.row) set_row(r, s.on, [&](std::uint32_t y) { return select(m, s.a ? a[y] : T(0.0), s.b ? b[y] : T(0.0)); });
      continue;
    }
    const bool linear = s.kind == Tape::Kind::linear;
    if (linear && !s.row) continue;
    const Partials p = linear ? Partials{T(s.by_a), T(s.by_b), T(0.0), T(0.0), T(0.0)} : partials(s);
    if (s.row && s.a && s.b)
      set_row(r, s.on, [&](std::uint32_t y) { return p.a * a[y] + p.b * b[y]; });
    else if (s.row)
      set_row(r, s.on, [&, by = s.a ? p.a : p.b, from = s.a ? a : b](std::uint32_t y) { return by * from[y]; });
    if (linear) continue;
    const T l = adjoints_[s.instruction.to];
    if (s.a && s.kind != Tape::Kind::product) add_square(l * p.aa, a, s.on_a);
    if (s.b && s.kind == Tape::Kind::curved) add_square(l * p.bb, b, s.on_b);
    if (!s.a || !s.b) continue;
    const T mixed = l * p.ab;
    for (const Tape::Run& x : s.on_a)
      for (std::uint32_t j = x.begin; j < x.end; ++j) {
        const T ca = mixed * a[j];
        T* to = mixed_.data() + j * n;
        for (const Tape::Run& y : s.on_b)
          for (std::uint32_t m = y.begin; m < y.end; ++m) to[m] += ca * b[m];
      }
  }
  for (std::size_t x = 0; x < n && !mixed_.empty(); ++x)
    for (std::size_t y = x; y < n; ++y) h[x * n + y] += mixed_[x * n + y] + mixed_[y * n + x];
}

}  // namespace karcher
