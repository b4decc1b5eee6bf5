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

/// Local coordinates on which the variables depend: of R^n one each, else the value on w, the derivative along t_a on w and k_a.
std::vector<std::vector<std::uint32_t>> dependences(const TermInput& input, const DensityVariables& variables, std::size_t parameters) {
  std::vector<std::vector<std::uint32_t>> on(variables.parameters + parameters);
  std::size_t begin = 0;
  for (std::size_t slot = 0; slot < input.fields.size(); ++slot) {
    const ManifoldOps& m = *input.field(slot).manifold;
    const auto n = static_cast<std::size_t>(m.ambient), k = static_cast<std::size_t>(m.dim);
    for (std::size_t a = 0; a <= static_cast<std::size_t>(input.region.dim); ++a)
      for (std::size_t c = 0; c < n; ++c) {
        auto& mine = on[variables.field[slot] + a * n + c];
        if (m.linear) {
          mine.push_back(static_cast<std::uint32_t>(begin + a * n + c));
          continue;
        }
        for (std::size_t i = 0; i < k; ++i) mine.push_back(static_cast<std::uint32_t>(begin + i));
        for (std::size_t i = 0; i < k && a > 0; ++i) mine.push_back(static_cast<std::uint32_t>(begin + a * k + i));
      }
    begin += (1 + static_cast<std::size_t>(input.region.dim)) * k;
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
        directions_(input.region.dim),
        program_(std::move(formula.program)),
        variables_(ambient(input)),
        tape_(program_, dependences(input, variables_, formula.parameters.size()), coordinates(input)),
        batches_(
            input, [&](CellKind kind) { return density_degree(input, kind); }, true),
        parameters_(batches_, std::move(formula.parameters), input.t) {
    for (const int f : input.fields) fields_.push_back({f, input.all_fields[static_cast<std::size_t>(f)]});
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
      std::fill(curvature.begin(), curvature.end(), T(0.0));
      for (std::size_t f = 0; f < slots.size(); ++f) {
        const Slot& s = slots[f];
        const std::size_t variable = variables_.field[f];
        s.kernel->differentiate(want);
        s.kernel->add_covector(l + variable, covector.data() + s.coordinate);
        s.kernel->add_gradient(covector.data() + s.coordinate, gradient.data() + s.unknown);
        if (want != Want::hessian) continue;
        s.kernel->rows(run.rows() + variable * local + s.coordinate, local);
        s.kernel->add_curvature(l + variable, curvature.data() + s.coordinate * local + s.coordinate, local);
        s.kernel->add_second_variation(covector.data() + s.coordinate);
      }
      if (want != Want::hessian) continue;
      run.add_curvature(curvature.data());
      for (const Slot& f : slots) {
        f.kernel->add_hessian(curvature.data() + f.coordinate * local + f.coordinate, local, hessian.data() + f.unknown * n + f.unknown, n);
        for (const Slot& g : std::span(slots).subspan(static_cast<std::size_t>(&f - slots.data()) + 1)) {
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
  /// A field on a batch.
  struct Slot {
    std::unique_ptr<FieldKernel> kernel;
    MaskOf<T> defined;
    std::size_t nodes, unknown, coordinate;  ///< its nodes; its first unknown of the cell and local coordinate of the point
  };

  std::vector<Slot> begin_cell(const Configuration& u, int b) const {
    const KindData& kind = batches_.kind(b);
    std::vector<Slot> slots;
    std::size_t unknown = 0, coordinate = 0;
    for (const auto& [number, field] : fields_) {
      Slot s;
      s.kernel = kernels_(field, directions_);
      s.defined = s.kernel->gather(u, number, batches_.batch(b), kind, slots.size());
      s.nodes = static_cast<std::size_t>(kind.shapes[slots.size()].nodes);
      s.unknown = unknown;
      s.coordinate = coordinate;
      unknown += s.nodes * s.kernel->dim();
      coordinate += s.kernel->local();
      slots.push_back(std::move(s));
    }
    return slots;
  }

  MaskOf<T> set_variables(int b, int q, const std::vector<Slot>& slots, T* v) const {
    const BatchPoint& point = batches_.point(b, q);
    const BatchReference& reference = batches_.reference(b, q);
    for (int i = 0; i < 3; ++i) v[DensityVariables::point + static_cast<std::size_t>(i)] = point.x[i];
    for (std::size_t a = 0; a < static_cast<std::size_t>(directions_); ++a)
      for (int i = 0; i < 3; ++i) v[DensityVariables::tangents + 3 * a + static_cast<std::size_t>(i)] = reference.tangent[a][i];
    const auto parameters = parameters_.at(batches_.point_index(b, q));
    std::copy(parameters.begin(), parameters.end(), v + variables_.parameters);
    MaskOf<T> defined = T(0.0) < T(1.0);
    for (std::size_t f = 0; f < slots.size(); ++f) {
      defined = defined & slots[f].kernel->move_to(point, batches_.kind(b), f, q);
      slots[f].kernel->jet(v + variables_.field[f]);
    }
    return defined;
  }

  TermInfo info_;
  FieldKernels kernels_;
  int directions_;
  Program program_;
  DensityVariables variables_;
  Tape tape_;
  CellBatches batches_;
  PointParameters parameters_;
  std::vector<std::pair<int, Field>> fields_;
};

}  // namespace

std::unique_ptr<Term> formula_term(TermInfo info, const TermInput& input, DensityFormula formula, FieldKernels kernels) {
  return std::make_unique<FormulaTerm>(std::move(info), input, std::move(formula), std::move(kernels));
}

}  // namespace karcher
