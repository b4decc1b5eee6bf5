#pragma once
// Problems small enough to know their minima: one field on a line of cells, energies given by a function of the nodal values of a cell.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "karcher/assembly/functional.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/solve/minimize.hpp"
#include "karcher/solve/petsc.hpp"

namespace karcher::testing {

/// What a cell contributes; gradient and Hessian in tangent coordinates of its nodes (n numbers, n x n row-major), null when not wanted.
struct CellValue {
  double energy = 0;
  Trouble trouble = Trouble::none;
};
/// (values of the cell's nodes, one pointer each; first node's position; t; gradient; Hessian)
using CellFunction = std::function<CellValue(const std::vector<const double*>&, const Vec3<double>&, double t, double* g, double* h)>;

class CellTerm : public Term {
 public:
  CellTerm(std::string name, const Field& field, const Layout& layout, CellFunction function)
      : info_{std::move(name), {}, {}, false, {}}, field_(field), function_(std::move(function)) {
    const Space& space = *field.space;
    for (std::size_t c = 0; c < space.region().cells.size(); ++c)
      if (layout.cell_rank(space.region().cells[c]) == layout.rank()) cells_.push_back(static_cast<int>(c));
    const auto nodes = cells_.empty() ? 0 : space.cell_nodes(cells_[0]).size();
    for (std::size_t k = 0; k < nodes; ++k) blocks_.push_back({0, field.manifold->dim});
    for (std::size_t first = 0; first < cells_.size(); first += native_width) {
      Batch& b = batches_.emplace_back();
      b.cells_used = static_cast<int>(std::min<std::size_t>(native_width, cells_.size() - first));
      b.blocks = &blocks_;
      b.nodes.resize(nodes * native_width);
      for (std::size_t lane = 0; lane < native_width; ++lane) {
        const int cell = cells_[first + std::min(lane, static_cast<std::size_t>(b.cells_used) - 1)];
        b.cells[lane] = cell;
        for (std::size_t k = 0; k < nodes; ++k) b.nodes[k * native_width + lane] = space.cell_nodes(cell)[k];
      }
    }
  }
  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return static_cast<int>(batches_.size()); }
  const Batch& batch(int b) const override { return batches_[static_cast<std::size_t>(b)]; }
  void set_load_parameter(double t) override { t_ = t; }
  const Cell& cell(int c) const override { return field_.space->region().cells[static_cast<std::size_t>(c)]; }
  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    const Batch& batch = batches_[static_cast<std::size_t>(b)];
    const std::size_t n = blocks_.size() * static_cast<std::size_t>(field_.manifold->dim);
    std::vector<double> g(n), h(n * n);
    for (std::size_t lane = 0; lane < native_width; ++lane) {
      std::vector<const double*> values;
      for (std::size_t k = 0; k < blocks_.size(); ++k) values.push_back(u.at(0, batch.nodes[k * native_width + lane], field_.manifold->ambient));
      std::fill(g.begin(), g.end(), 0.0);
      std::fill(h.begin(), h.end(), 0.0);
      const Vec3<double>& place = field_.space->position(batch.nodes[lane]);
      const CellValue value = function_(values, place, t_, want == Want::energy ? nullptr : g.data(), want == Want::hessian ? h.data() : nullptr);
      out.energy[lane] = value.energy;
      out.trouble[lane] = value.trouble;
      for (std::size_t i = 0; want != Want::energy && i < n; ++i) out.gradient[i * native_width + lane] = g[i];
      for (std::size_t i = 0; want == Want::hessian && i < n * n; ++i) out.hessian[i * native_width + lane] = h[i];
    }
  }

 private:
  TermInfo info_;
  Field field_;
  CellFunction function_;
  std::vector<int> cells_;
  std::vector<LocalBlock> blocks_;
  std::vector<Batch> batches_;
  double t_ = 0;
};

/// The interval [0, cells] cut into unit cells, or (cells = 0) the one point 0.
inline std::shared_ptr<Mesh> line_mesh(int cells) {
  auto mesh = std::make_shared<Mesh>();
  mesh->dim = 1;
  for (int i = 0; i <= cells; ++i) mesh->nodes.push_back({{static_cast<double>(i), 0, 0}});
  for (int i = 0; i < cells; ++i) {
    Cell c;
    c.kind = CellKind::line;
    c.nodes = {i, i + 1};
    mesh->cells.push_back(c);
  }
  mesh->regions["all"] = {"all", 1, mesh->cells};
  return mesh;
}

struct SmallProblem {
  std::shared_ptr<Mesh> mesh;
  Field field;
  std::shared_ptr<Layout> layout;
  std::unique_ptr<Functional> functional;
  Configuration u;

  /// initial: ambient coordinates node after node; fixed: tangent components node after node (may be empty)
  SmallProblem(int cells, const ManifoldOps& manifold, CellFunction function, std::vector<double> initial, std::vector<char> fixed = {}) {
    mesh = line_mesh(cells);
    field.name = std::string("u");
    field.manifold = &manifold;
    field.space = std::make_shared<Space>(mesh, mesh->regions.at("all"), 1);
    const std::vector<Field> fields{field};
    layout = std::make_shared<Layout>(fields, std::vector<std::vector<char>>{std::move(fixed)}, partition_cells(*mesh, world_size()), world_rank(),
                                      world_size());
    std::vector<std::unique_ptr<Term>> terms;
    terms.push_back(std::make_unique<CellTerm>("test-term", field, *layout, std::move(function)));
    functional = std::make_unique<Functional>(layout, std::move(terms));
    // Space numbers nodes as it likes: initial values are given in the order of x.
    const auto ambient = static_cast<std::size_t>(manifold.ambient);
    u.values.emplace_back(initial.size());
    for (int node = 0; node < field.space->node_count(); ++node)
      for (std::size_t k = 0; k < ambient; ++k)
        u.values[0][static_cast<std::size_t>(node) * ambient + k] =
            initial[static_cast<std::size_t>(field.space->position(node)[0] + 0.5) * ambient + k];
  }
  /// Value of a component at the node with x = i, on all ranks (after complete()).
  double value(int i, int component = 0) const {
    for (int node = 0; node < field.space->node_count(); ++node)
      if (static_cast<int>(field.space->position(node)[0] + 0.5) == i) return u.at(0, node, field.manifold->ambient)[component];
    return NAN;
  }
};

}  // namespace karcher::testing
