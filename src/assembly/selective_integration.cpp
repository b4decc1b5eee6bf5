#include "karcher/assembly/selective_integration.hpp"

#include <algorithm>
#include <cmath>

#include "karcher/mesh/reference_geometry.hpp"

namespace karcher {
namespace {

class SumOfParts : public Term {
 public:
  explicit SumOfParts(std::vector<std::unique_ptr<Term>> parts) : parts_(std::move(parts)) {}

  const TermInfo& info() const override { return first().info(); }
  int batch_count() const override { return first().batch_count(); }
  const Batch& batch(int b) const override { return first().batch(b); }
  const Cell& cell(int c) const override { return first().cell(c); }
  std::vector<std::string> warnings() const override { return first().warnings(); }
  std::vector<double> stress_free(int field) const override { return first().stress_free(field); }
  void set_load_parameter(double t) override {
    for (const auto& part : parts_) part->set_load_parameter(t);
  }

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    first().evaluate(u, b, want, out);
    more_.gradient.resize(out.gradient.size());
    more_.hessian.resize(out.hessian.size());
    for (std::size_t k = 1; k < parts_.size(); ++k) {
      parts_[k]->evaluate(u, b, want, more_);
      for (std::size_t lane = 0; lane < out.energy.size(); ++lane) {
        out.energy[lane] += more_.energy[lane];
        if (out.trouble[lane] == Trouble::none) out.trouble[lane] = more_.trouble[lane];
      }
      if (want == Want::energy) continue;
      for (std::size_t i = 0; i < out.gradient.size(); ++i) out.gradient[i] += more_.gradient[i];
      if (want == Want::hessian)
        for (std::size_t i = 0; i < out.hessian.size(); ++i) out.hessian[i] += more_.hessian[i];
    }
  }

  std::vector<std::array<double, native_width>> batch_part_energies(const Configuration& u, int b) const override {
    auto energies = first().batch_part_energies(u, b);
    for (std::size_t k = 1; k < parts_.size(); ++k) {
      const auto more = parts_[k]->batch_part_energies(u, b);
      for (std::size_t p = 0; p < energies.size(); ++p)
        for (std::size_t lane = 0; lane < energies[p].size(); ++lane) energies[p][lane] += more[p][lane];
    }
    return energies;
  }
  std::vector<std::array<double, native_width>> batch_quantities(const Configuration& u, int b) const override {
    return parts_[1]->batch_quantities(u, b);
  }

 private:
  const Term& first() const { return *parts_.front(); }

  std::vector<std::unique_ptr<Term>> parts_;
  mutable BatchResult more_;  // working space of evaluate()
};

}  // namespace

SelectiveFactors selective_factors(SelectivePart part) {
  switch (part) {
    case SelectivePart::all_points:
      return {0, 1, 0, 1, 1};
    case SelectivePart::membrane:
      return {1, -1, 0, 0, 0};
    case SelectivePart::shear:
      return {0, 0, 1, -1, 0};
    case SelectivePart::membrane_and_shear:
      return {1, -1, 1, -1, 0};
    case SelectivePart::whole:
      break;
  }
  return {};
}

int reduced_degree(SelectivePart part, CellKind kind, int highest_order) {
  if (kind != CellKind::triangle) return 2 * highest_order - 1;
  return std::max(1, 2 * highest_order - (part == SelectivePart::shear ? 3 : 2));
}

std::vector<SelectivePart> selective_parts(const Region& region) {
  const bool triangles = std::any_of(region.cells.begin(), region.cells.end(), [](const Cell& c) { return c.kind == CellKind::triangle; });
  if (triangles) return {SelectivePart::all_points, SelectivePart::membrane, SelectivePart::shear};
  return {SelectivePart::all_points, SelectivePart::membrane_and_shear};
}

std::vector<double> cell_diameters(const TermInput& input) {
  const ReferenceGeometry reference(*input.mesh, input.reference_position, input.reference_order);
  std::vector<double> diameters;
  for (const Cell& cell : input.region.cells) {
    const auto vertices = reference.at(cell, lagrange_nodes(cell.kind, 1));
    double largest = 0;
    for (const GeometryJet& a : vertices)
      for (const GeometryJet& b : vertices) largest = std::max(largest, norm2(a.x - b.x));
    diameters.push_back(std::sqrt(largest));
  }
  return diameters;
}

std::unique_ptr<Term> make_sum_of_parts(std::vector<std::unique_ptr<Term>> parts) { return std::make_unique<SumOfParts>(std::move(parts)); }

}  // namespace karcher
