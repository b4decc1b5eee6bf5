// The sums of a Functional against dense sums over cells, for every way in which unknowns of cells meet blocks of the matrix, on one rank and as several see it.
#include "karcher/assembly/functional.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "karcher/mesh/generators.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/testing/random.hpp"

namespace karcher {
namespace {

constexpr std::size_t W = native_width;

/// Energy 1/2 x.A x + b.x of every cell, x the values of all fields at its nodes, A symmetric and b random by cell.
class QuadraticTerm : public Term {
 public:
  /// cells: of the mesh
  QuadraticTerm(std::vector<Field> fields, std::vector<int> cells) : fields_(std::move(fields)), cells_(std::move(cells)) {
    const Mesh& mesh = fields_[0].space->mesh();
    for (int f = 0; f < static_cast<int>(fields_.size()); ++f) {
      const Field& field = fields_[static_cast<std::size_t>(f)];
      const auto count = field.space->entity_nodes(mesh.cells[0]).size();
      for (std::size_t k = 0; k < count; ++k) blocks_.push_back({f, field.manifold->dim});
      unknowns_ += count * static_cast<std::size_t>(field.manifold->dim);
    }
    for (std::size_t first = 0; first < cells_.size(); first += W) {
      Batch& b = batches_.emplace_back();
      b.cells_used = static_cast<int>(std::min(W, cells_.size() - first));
      b.blocks = &blocks_;
      b.nodes.resize(blocks_.size() * W);
      for (std::size_t lane = 0; lane < W; ++lane) {
        b.cells[lane] = cells_[first + std::min(lane, static_cast<std::size_t>(b.cells_used) - 1)];
        std::size_t block = 0;
        for (const Field& field : fields_)
          for (int node : field.space->entity_nodes(mesh.cells[static_cast<std::size_t>(b.cells[lane])])) b.nodes[block++ * W + lane] = node;
      }
    }
  }
  const TermInfo& info() const override { return info_; }
  int batch_count() const override { return static_cast<int>(batches_.size()); }
  const Batch& batch(int b) const override { return batches_[static_cast<std::size_t>(b)]; }
  const Cell& cell(int c) const override { return fields_[0].space->mesh().cells[static_cast<std::size_t>(c)]; }

  struct CellData {
    std::vector<double> a, b;  // row-major
  };
  CellData data(int cell) const {
    Random random(static_cast<std::uint64_t>(cell) + 7);
    CellData d;
    d.a.resize(unknowns_ * unknowns_);
    for (std::size_t i = 0; i < unknowns_; ++i)
      for (std::size_t j = i; j < unknowns_; ++j) d.a[i * unknowns_ + j] = d.a[j * unknowns_ + i] = random.uniform(-1, 1);
    for (std::size_t i = 0; i < unknowns_; ++i) d.b.push_back(random.uniform(-1, 1));
    return d;
  }
  std::size_t unknowns() const { return unknowns_; }

  void evaluate(const Configuration& u, int b, Want want, BatchResult& out) const override {
    const Batch& batch = batches_[static_cast<std::size_t>(b)];
    for (std::size_t lane = 0; lane < W; ++lane) {
      const CellData d = data(batch.cells[lane]);
      std::vector<double> x, g = d.b;
      for (std::size_t k = 0; k < blocks_.size(); ++k) {
        const double* value = u.at(blocks_[k].field, batch.nodes[k * W + lane], blocks_[k].dim);
        x.insert(x.end(), value, value + blocks_[k].dim);
      }
      out.energy[lane] = 0;
      for (std::size_t i = 0; i < unknowns_; ++i) {
        for (std::size_t j = 0; j < unknowns_; ++j) g[i] += d.a[i * unknowns_ + j] * x[j];
        out.energy[lane] += 0.5 * x[i] * (g[i] + d.b[i]);
        if (want != Want::energy) out.gradient[i * W + lane] = g[i];
        // Entries below the diagonal blocks are undefined: they must not be read.
        for (std::size_t j = 0; want == Want::hessian && j < unknowns_; ++j)
          out.hessian[(i * unknowns_ + j) * W + lane] = block_of(j) < block_of(i) ? NAN : d.a[i * unknowns_ + j];
      }
    }
  }

 private:
  std::size_t block_of(std::size_t unknown) const {
    std::size_t block = 0;
    for (std::size_t end = static_cast<std::size_t>(blocks_[0].dim); unknown >= end; end += static_cast<std::size_t>(blocks_[++block].dim)) {
    }
    return block;
  }
  TermInfo info_{"quadratic", {}, {}, false, {}};
  std::vector<Field> fields_;
  std::vector<int> cells_;
  std::vector<LocalBlock> blocks_;
  std::vector<Batch> batches_;
  std::size_t unknowns_ = 0;
};

/// Dense sums, in the order field, node, component.
struct Dense {
  std::size_t n = 0;
  double energy = 0;
  std::vector<double> g, h;
};

struct Setting {
  std::shared_ptr<const Mesh> mesh = std::make_shared<const Mesh>(generate({"rectangle", {{"cells", {4, 3}}}, {}}));
  std::vector<Field> fields;
  Configuration u;

  explicit Setting(const std::vector<std::pair<const char*, int>>& wanted) {
    Random random(2);
    for (const auto& [manifold, order] : wanted) {
      fields.push_back({std::string(1, static_cast<char>('a' + fields.size())), &manifold_by_name(manifold), Rule::projection,
                        std::make_shared<Space>(mesh, mesh->region("all"), order)});
      auto& values = u.values.emplace_back(static_cast<std::size_t>(fields.back().space->node_count() * fields.back().manifold->dim));
      for (double& x : values) x = random.uniform(-1, 1);
    }
  }
  /// Number of component 0 of a node.
  std::size_t place(int field, int node) const {
    int before = 0;
    for (int f = 0; f < field; ++f)
      before += fields[static_cast<std::size_t>(f)].space->node_count() * fields[static_cast<std::size_t>(f)].manifold->dim;
    return static_cast<std::size_t>(before + node * fields[static_cast<std::size_t>(field)].manifold->dim);
  }
  std::size_t unknowns() const { return place(static_cast<int>(fields.size()) - 1, fields.back().space->node_count()); }
  std::vector<int> all_cells() const {
    std::vector<int> cells(mesh->cells.size());
    std::iota(cells.begin(), cells.end(), 0);
    return cells;
  }

  Dense expected() const {
    Dense d;
    d.n = unknowns();
    d.g.resize(d.n);
    d.h.resize(d.n * d.n);
    const QuadraticTerm term(fields, all_cells());
    for (int cell : all_cells()) {
      const auto data = term.data(cell);
      std::vector<std::size_t> at;
      std::vector<double> x;
      for (int f = 0; f < static_cast<int>(fields.size()); ++f)
        for (int node : fields[static_cast<std::size_t>(f)].space->entity_nodes(mesh->cells[static_cast<std::size_t>(cell)]))
          for (int k = 0; k < fields[static_cast<std::size_t>(f)].manifold->dim; ++k) {
            at.push_back(place(f, node) + static_cast<std::size_t>(k));
            x.push_back(
                u.values[static_cast<std::size_t>(f)][static_cast<std::size_t>(node * fields[static_cast<std::size_t>(f)].manifold->dim + k)]);
          }
      for (std::size_t i = 0; i < at.size(); ++i) {
        d.energy += data.b[i] * x[i];
        d.g[at[i]] += data.b[i];
        for (std::size_t j = 0; j < at.size(); ++j) {
          const double a = data.a[i * at.size() + j];
          d.energy += 0.5 * x[i] * a * x[j];
          d.g[at[i]] += a * x[j];
          d.h[at[i] * d.n + at[j]] += a;
        }
      }
    }
    return d;
  }

  /// What the functionals of all ranks add up to.
  Dense found(int ranks) const {
    Dense d;
    d.n = unknowns();
    d.g.resize(d.n);
    d.h.resize(d.n * d.n);
    const CellRanks cell_ranks = partition_cells(*mesh, ranks);
    const std::vector<std::vector<char>> fixed(fields.size());
    for (int rank = 0; rank < ranks; ++rank) {
      const auto layout = std::make_shared<const Layout>(fields, fixed, cell_ranks, rank, ranks);
      std::vector<int> cells;
      for (int c : all_cells())
        if (cell_ranks[static_cast<std::size_t>(c)] == rank) cells.push_back(c);
      std::vector<std::unique_ptr<Term>> terms;
      terms.push_back(std::make_unique<QuadraticTerm>(fields, cells));
      const Functional functional(layout, std::move(terms));
      std::vector<double> g(static_cast<std::size_t>(layout->local_dofs()), 7.0), again(g);
      BlockMatrix h = functional.make_matrix();
      std::fill(h.values.begin(), h.values.end(), 7.0);
      const Evaluation e = functional.hessian(u, g, h);
      EXPECT_FALSE(e.failure) << e.failure->sentence();
      d.energy += e.energy;
      EXPECT_EQ(functional.energy(u).energy, e.energy);
      EXPECT_EQ(functional.gradient(u, again).energy, e.energy);
      EXPECT_EQ(again, g);

      std::vector<std::size_t> at(g.size());
      for (int f = 0; f < static_cast<int>(fields.size()); ++f)
        for (int node : layout->local_nodes(f))
          for (int k = 0; k < fields[static_cast<std::size_t>(f)].manifold->dim; ++k)
            at[static_cast<std::size_t>(layout->first_dof(f, node) + k)] = place(f, node) + static_cast<std::size_t>(k);
      for (std::size_t i = 0; i < g.size(); ++i) d.g[at[i]] += g[i];
      add_matrix(*layout, h, at, d);
    }
    return d;
  }

  static void add_matrix(const Layout& layout, const BlockMatrix& h, const std::vector<std::size_t>& at, Dense& d) {
    const auto bs = static_cast<std::size_t>(h.block_size);
    const auto& global = layout.local_to_global();
    ASSERT_EQ(h.row_begin.size(), global.size() + 1);
    for (std::size_t i = 0; i < global.size(); ++i) {
      EXPECT_EQ(static_cast<std::size_t>(h.column[static_cast<std::size_t>(h.row_begin[i])]), i);  // the diagonal block is the first of its row
      for (int k = h.row_begin[i]; k < h.row_begin[i + 1]; ++k) {
        const auto j = static_cast<std::size_t>(h.column[static_cast<std::size_t>(k)]);
        if (k > h.row_begin[i]) {
          EXPECT_LT(global[static_cast<std::size_t>(h.column[static_cast<std::size_t>(k) - 1])], global[j]);
        }
        for (std::size_t c = 0; c < bs; ++c)
          for (std::size_t r = 0; r < bs; ++r) {
            const double x = h.values[static_cast<std::size_t>(k) * bs * bs + c * bs + r];
            d.h[at[i * bs + r] * d.n + at[j * bs + c]] += x;
            if (i != j) d.h[at[j * bs + c] * d.n + at[i * bs + r]] += x;
          }
      }
    }
  }
};

TEST(Functional, SumsCellsAsDenseMatricesDoWhateverTheBlocksAndRanks) {
  for (const auto& wanted : std::vector<std::vector<std::pair<const char*, int>>>{{{"R3", 2}},
                                                                                  {{"R3", 1}, {"R3", 1}},     // two pieces in a block of six
                                                                                  {{"R3", 2}, {"R3", 1}},     // blocks of three
                                                                                  {{"R2", 1}, {"R1", 2}},     // a node in two blocks
                                                                                  {{"R3", 1}, {"R2", 2}}}) {  // blocks of one
    const Setting s(wanted);
    const Dense expected = s.expected();
    for (const int ranks : {1, 2, 3}) {
      const Dense found = s.found(ranks);
      EXPECT_NEAR(found.energy, expected.energy, 1e-11);
      for (std::size_t i = 0; i < expected.n; ++i) {
        EXPECT_NEAR(found.g[i], expected.g[i], 1e-12);
        for (std::size_t j = 0; j < expected.n; ++j) ASSERT_NEAR(found.h[i * expected.n + j], expected.h[i * expected.n + j], 1e-13) << i << " " << j;
      }
    }
  }
}

}  // namespace
}  // namespace karcher
