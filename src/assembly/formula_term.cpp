#include "karcher/assembly/formula_term.hpp"

#include <algorithm>

#include "karcher/assembly/density_term.hpp"
#include "karcher/assembly/point_parameters.hpp"
#include "karcher/expression/tape.hpp"

namespace karcher {
namespace {

using T = NativeScalar;

std::vector<int> ambient(const TermInput& input) {
  std::vector<int> n;
  for (std::size_t slot = 0; slot < input.fields.size(); ++slot) n.push_back(input.field(slot).manifold->ambient);
  return n;
}

/// Local coordinates on which the variables depend: of R^n a value on one, a derivative along t_a on one; else a value on w, a derivative along t_a on w and k_a.
std::vector<std::vector<std::uint32_t>> dependences(const TermInput& input, const DensityVariables& variables, std::size_t parameters) {
  std::vector<std::vector<std::uint32_t>> on(variables.parameters() + parameters);
  const auto directions = static_cast<std::size_t>(input.region.dim);
  std::size_t begin = 0;
  for (std::size_t slot = 0; slot < input.fields.size(); ++slot) {
    const ManifoldOps& m = *input.field(slot).manifold;
    const auto n = static_cast<std::size_t>(m.ambient), k = static_cast<std::size_t>(m.dim);
    // The a-th of w, k_1, k_2, ... of the component c.
    const auto add = [&](std::vector<std::uint32_t>& to, std::size_t a, std::size_t c) {
      for (std::size_t i = m.linear ? c : 0; i < (m.linear ? c + 1 : k); ++i) to.push_back(static_cast<std::uint32_t>(begin + a * k + i));
    };
    for (std::size_t c = 0; c < n; ++c) {
      add(on[variables.value(slot) + c], 0, c);
      for (std::size_t a = 0; a < directions; ++a) {
        auto& along = on[variables.direction(slot, a) + c];
        if (!m.linear) add(along, 0, c);
        add(along, 1 + a, c);
      }
      for (std::size_t axis = 0; axis < 3 && (directions == 1 || directions == 2); ++axis) {
        auto& along = on[variables.axis(slot, axis) + c];
        for (std::size_t a = m.linear ? 1 : 0; a <= directions; ++a) add(along, a, c);
      }
    }
    begin += (1 + directions) * k;
  }
  return on;
}

std::size_t coordinates(const TermInput& input) {
  int sum = 0;
  for (std::size_t slot = 0; slot < input.fields.size(); ++slot) sum += (1 + input.region.dim) * input.field(slot).manifold->dim;
  return static_cast<std::size_t>(sum);
}

class FormulaTerm : public Term {
 public:
  FormulaTerm(TermInfo info, const TermInput& input, DensityFormula formula, FieldKernels kernels)
      : info_(std::move(info)),
        kernels_(std::move(kernels)),
        directions_(static_cast<std::size_t>(input.region.dim)),
        program_(std::move(formula.program)),
        variables_(ambient(input)),
        tape_(program_, dependences(input, variables_, formula.parameters.size()), coordinates(input)),
        batches_(
            input, [&](CellKind kind) { return density_degree(input, kind); }, true),
        parameters_(batches_, std::move(formula.parameters), input.t) {
    for (std::size_t slot = 0; slot < input.fields.size(); ++slot) {
      const std::vector<std::uint32_t>& used = program_.inputs();
      const bool axes =
          std::any_of(used.begin(), used.end(), [&](std::uint32_t v) { return v >= variables_.axis(slot, 0) && v < variables_.direction(slot, 0); });
      fields_.push_back({input.fields[slot], input.field(slot), axes});
    }
  }

  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return batches_.count(); }
  const Batch& batch(int b) const override { return batches_.batch(b); }
  const Cell& cell(int c) const override { return batches_.cell(c); }
  void set_load_parameter(double t) override { parameters_.set_load_parameter(batches_, t); }

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    const KindData& kind = batches_.kind(b);
    std::vector<Slot> slots = begin_cell(u, b);
    MaskOf<T> defined = T(0.0) < T(1.0);
    for (const Slot& s : slots) defined = defined & s.defined;
    T energy = T(0.0);

    if (want == Want::energy) {
      std::vector<T> places(std::max(program_.size(), tape_.variables()), T(0.0));
      for (int q = 0; q < kind.quadrature->size(); ++q) {
        defined = defined & set_variables(b, q, slots, places.data());
        energy += batches_.point(b, q).weight * program_.evaluate_in(places.data());
      }
      report_lanes(energy, defined, out);
      return;
    }

    const auto n = static_cast<std::size_t>(kind.unknowns);
    const std::size_t local = tape_.coordinates();
    TapeRun run(tape_);
    std::vector<T> gradient(n, T(0.0)), hessian(want == Want::hessian ? n * n : 0, T(0.0)), covector(local), curvature(local * local), product;
    for (int q = 0; q < kind.quadrature->size(); ++q) {
      defined = defined & set_variables(b, q, slots, run.values());
      const T weight = batches_.point(b, q).weight;
      energy += weight * run.value();
      const T* l = run.adjoints(weight);
      std::fill(covector.begin(), covector.end(), T(0.0));
      for (Slot& s : slots) {
        set_adjoints(b, q, s, l);
        s.kernel->differentiate(want);
        s.kernel->add_covector(s.adjoints.data(), covector.data() + s.coordinate);
        s.kernel->add_gradient(covector.data() + s.coordinate, gradient.data() + s.unknown);
        if (want == Want::hessian) set_rows(b, q, s, run.rows());
      }
      if (want != Want::hessian) continue;
      run.curvature(curvature.data());
      for (const Slot& f : slots) {
        T* own = curvature.data() + f.coordinate * local + f.coordinate;
        f.kernel->add_curvature(f.adjoints.data(), own, local);
        f.kernel->add_second_variation(covector.data() + f.coordinate);
        f.kernel->add_hessian(own, local, hessian.data() + f.unknown * n + f.unknown, n);
        for (const Slot& g : std::span(slots).subspan(f.number + 1)) {
          product.resize(f.kernel->local() * g.kernel->dim());
          for (std::size_t j = 0; j < g.nodes; ++j) {
            g.kernel->times_map(curvature.data() + f.coordinate * local + g.coordinate, local, f.kernel->local(), j, product.data());
            f.kernel->add_transposed(product.data(), g.kernel->dim(), hessian.data() + f.unknown * n + g.unknown + j * g.kernel->dim(), n);
          }
        }
      }
    }
    for (const Slot& s : slots)
      if (want == Want::hessian) s.kernel->finish(hessian.data() + s.unknown * n + s.unknown, n);
    report_lanes(energy, defined, out);
    store_lanes(gradient, out.gradient);
    store_lanes(hessian, out.hessian);
  }

 private:
  /// A field of the term.
  struct Known {
    int number;
    Field field;
    bool axes;  ///< whether the formula uses derivatives along the axes
  };
  /// A field on a batch.
  struct Slot {
    std::size_t number;
    std::unique_ptr<FieldKernel> kernel;
    MaskOf<T> defined;
    std::size_t nodes, unknown, coordinate;  ///< its nodes; its first unknown of the cell and local coordinate of the point
    std::vector<T> adjoints{};               ///< derivatives of the density by value and derivatives along the directions
  };

  std::vector<Slot> begin_cell(const Configuration& u, int b) const {
    const KindData& kind = batches_.kind(b);
    std::vector<Slot> slots;
    std::size_t unknown = 0, coordinate = 0;
    for (const Known& f : fields_) {
      Slot s{slots.size(), kernels_(f.field, static_cast<int>(directions_)), {}, static_cast<std::size_t>(kind.shapes[slots.size()].nodes), unknown,
             coordinate};
      s.defined = s.kernel->gather(u, f.number, batches_.batch(b), kind, s.number);
      s.adjoints.resize((1 + directions_) * s.kernel->ambient());
      unknown += s.nodes * s.kernel->dim();
      coordinate += s.kernel->local();
      slots.push_back(std::move(s));
    }
    return slots;
  }

  MaskOf<T> set_variables(int b, int q, const std::vector<Slot>& slots, T* v) const {
    const BatchPoint& point = batches_.point(b, q);
    for (int i = 0; i < 3; ++i) v[DensityVariables::point + static_cast<std::size_t>(i)] = point.x[i];
    const auto parameters = parameters_.at(batches_.point_index(b, q));
    std::copy(parameters.begin(), parameters.end(), v + variables_.parameters());
    MaskOf<T> defined = T(0.0) < T(1.0);
    for (const Slot& s : slots) {
      defined = defined & s.kernel->move_to(point, batches_.kind(b), s.number, q);
      s.kernel->jet(v + variables_.value(s.number), v + variables_.direction(s.number, 0));
      along_axes(b, q, s, v, s.kernel->ambient());
    }
    return defined;
  }

  /// The derivatives along the axes, sum_a t_a d_a u, in an array of so many numbers for all components in every variable.
  void along_axes(int b, int q, const Slot& s, T* numbers, std::size_t count) const {
    if (!fields_[s.number].axes) return;
    const std::size_t each = count / s.kernel->ambient();
    const BatchReference& reference = batches_.reference(b, q);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      T* to = numbers + variables_.axis(s.number, axis) * each;
      const T *first = numbers + variables_.direction(s.number, 0) * each, *second = numbers + variables_.direction(s.number, 1) * each;
      const T x = reference.tangent[0][static_cast<int>(axis)], y = reference.tangent[1][static_cast<int>(axis)];
      if (directions_ == 1)
        for (std::size_t i = 0; i < count; ++i) to[i] = x * first[i];
      else
        for (std::size_t i = 0; i < count; ++i) to[i] = x * first[i] + y * second[i];
    }
  }

  void set_adjoints(int b, int q, Slot& s, const T* l) const {
    const std::size_t n = s.kernel->ambient();
    std::copy_n(l + variables_.value(s.number), n, s.adjoints.data());
    std::copy_n(l + variables_.direction(s.number, 0), directions_ * n, s.adjoints.data() + n);
    if (!fields_[s.number].axes) return;
    const BatchReference& reference = batches_.reference(b, q);
    for (std::size_t a = 0; a < directions_; ++a)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const T* along = l + variables_.axis(s.number, axis);
        for (std::size_t c = 0; c < n; ++c) s.adjoints[(1 + a) * n + c] += reference.tangent[a][static_cast<int>(axis)] * along[c];
      }
  }

  void set_rows(int b, int q, const Slot& s, T* rows) const {
    const std::size_t local = tape_.coordinates();
    s.kernel->rows(rows + variables_.value(s.number) * local + s.coordinate, rows + variables_.direction(s.number, 0) * local + s.coordinate, local);
    along_axes(b, q, s, rows, s.kernel->ambient() * local);
  }

  TermInfo info_;
  FieldKernels kernels_;
  std::size_t directions_;
  Program program_;
  DensityVariables variables_;
  Tape tape_;
  CellBatches batches_;
  PointParameters parameters_;
  std::vector<Known> fields_;
};

}  // namespace

std::unique_ptr<Term> formula_term(TermInfo info, const TermInput& input, DensityFormula formula, FieldKernels kernels) {
  return std::make_unique<FormulaTerm>(std::move(info), input, std::move(formula), std::move(kernels));
}

}  // namespace karcher
