#include "karcher/assembly/functional.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "karcher/error.hpp"

namespace karcher {
namespace {

constexpr int W = native_width;

/// A run of local unknowns that lies inside one block of the matrix.
struct Piece {
  int block = 0;   ///< local block of the batch
  int offset = 0;  ///< first unknown within that block
  int size = 0;
  int begin = 0;  ///< first unknown within the cell
};

std::vector<Piece> pieces_of(const std::vector<LocalBlock>& blocks, int block_size) {
  std::vector<Piece> pieces;
  int begin = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const int size = std::min(blocks[b].dim, block_size);
    for (int o = 0; o < blocks[b].dim; o += size) pieces.push_back({static_cast<int>(b), o, size, begin + o});
    begin += blocks[b].dim;
  }
  return pieces;
}

std::string_view sentence_of(Trouble t) {
  switch (t) {
    case Trouble::undefined_interpolation:
      return "the interpolation of the nodal values is not defined there (they are too far apart)";
    case Trouble::infinite_energy:
      return "the energy density is infinite there";
    case Trouble::not_finite:
      return "the energy or its derivatives are not finite there";
    case Trouble::none:
      break;
  }
  return "no trouble";
}

}  // namespace

std::string EvaluationFailure::sentence() const {
  return fmt::format("{} in the cell around ({:.6g}, {:.6g}, {:.6g}): {}.", term, place[0], place[1], place[2], sentence_of(trouble));
}

/// Where the entries of a batch go. A target is the position of a piece pair's first entry in the matrix.
struct Functional::Scatter {
  struct Target {
    int position = 0;
    bool transposed = false;  ///< the pair (i, j) is stored as (j, i)
    bool both = false;        ///< inside a diagonal block: stored twice
  };
  std::vector<Piece> pieces;
  std::vector<std::array<int, W>> dofs;        ///< [piece][lane] first local dof
  std::vector<std::array<Target, W>> targets;  ///< [pair of pieces i <= j][lane]
  int unknowns = 0;
};

Functional::Functional(std::shared_ptr<const Layout> layout, std::vector<std::unique_ptr<Term>> terms)
    : layout_(std::move(layout)), terms_(std::move(terms)) {
  const int bs = layout_->block_size();
  const std::vector<int>& global = layout_->local_to_global();

  // Pass 1: where every piece stands, and which blocks meet.
  std::vector<std::pair<int, int>> met;
  for (int b = 0; b < layout_->local_blocks(); ++b) met.emplace_back(b, b);
  for (const auto& term : terms_)
    for (int k = 0; k < term->batch_count(); ++k) {
      const Batch& batch = term->batch(k);
      auto scatter = std::make_shared<Scatter>();
      scatter->pieces = pieces_of(*batch.blocks, bs);
      scatter->unknowns = scatter->pieces.back().begin + scatter->pieces.back().size;
      for (const Piece& p : scatter->pieces) {
        auto& dofs = scatter->dofs.emplace_back();
        for (int lane = 0; lane < W; ++lane) {
          const auto b = static_cast<std::size_t>(p.block);
          const int node = batch.nodes[b * W + static_cast<std::size_t>(std::min(lane, batch.cells_used - 1))];
          dofs[static_cast<std::size_t>(lane)] = layout_->first_dof((*batch.blocks)[b].field, node) + p.offset;
        }
      }
      for (std::size_t i = 0; i < scatter->pieces.size(); ++i)
        for (std::size_t j = i + 1; j < scatter->pieces.size(); ++j)
          for (int lane = 0; lane < batch.cells_used; ++lane) {
            int row = scatter->dofs[i][static_cast<std::size_t>(lane)] / bs, column = scatter->dofs[j][static_cast<std::size_t>(lane)] / bs;
            if (global[static_cast<std::size_t>(row)] > global[static_cast<std::size_t>(column)]) std::swap(row, column);
            met.emplace_back(row, column);
          }
      scatter_.push_back(std::move(scatter));
      if (met.size() > 20'000'000) {  // bounds the memory of the list on large meshes
        std::sort(met.begin(), met.end());
        met.erase(std::unique(met.begin(), met.end()), met.end());
      }
    }
  const auto by_row_then_global_column = [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : global[static_cast<std::size_t>(a.second)] < global[static_cast<std::size_t>(b.second)];
  };
  std::sort(met.begin(), met.end(), by_row_then_global_column);
  met.erase(std::unique(met.begin(), met.end()), met.end());
  row_begin_.assign(static_cast<std::size_t>(layout_->local_blocks()) + 1, 0);
  for (const auto& [row, column] : met) {
    ++row_begin_[static_cast<std::size_t>(row) + 1];
    column_.push_back(column);
  }
  for (std::size_t i = 1; i < row_begin_.size(); ++i) row_begin_[i] += row_begin_[i - 1];
  if (column_.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / (bs * bs)))
    throw Error("The Hessian has more entries than one rank can address; use more ranks.");

  // Pass 2: positions in the matrix.
  const auto position = [&](int row, int column) {
    const auto begin = column_.begin() + row_begin_[static_cast<std::size_t>(row)],
               end = column_.begin() + row_begin_[static_cast<std::size_t>(row) + 1];
    const auto at =
        std::lower_bound(begin, end, global[static_cast<std::size_t>(column)], [&](int c, int g) { return global[static_cast<std::size_t>(c)] < g; });
    return static_cast<int>(at - column_.begin()) * bs * bs;
  };
  for (auto& scatter : scatter_)
    for (std::size_t i = 0; i < scatter->pieces.size(); ++i)
      for (std::size_t j = i; j < scatter->pieces.size(); ++j) {
        auto& targets = scatter->targets.emplace_back();
        for (std::size_t lane = 0; lane < W; ++lane) {
          const int di = scatter->dofs[i][lane], dj = scatter->dofs[j][lane];
          const int row = di / bs, column = dj / bs;
          Scatter::Target& t = targets[lane];
          t.transposed = global[static_cast<std::size_t>(row)] > global[static_cast<std::size_t>(column)];
          t.both = row == column && i != j;
          // column-major blocks: entry (r, c) stands at c * bs + r
          t.position = t.transposed ? position(column, row) + (di % bs) * bs + dj % bs : position(row, column) + (dj % bs) * bs + di % bs;
        }
      }
}

void Functional::set_load_parameter(double t) {
  for (auto& term : terms_) term->set_load_parameter(t);
}

BlockMatrix Functional::make_matrix() const {
  BlockMatrix m;
  m.block_size = layout_->block_size();
  m.row_begin = row_begin_;
  m.column = column_;
  m.values.assign(column_.size() * static_cast<std::size_t>(m.block_size * m.block_size), 0.0);
  return m;
}

Evaluation Functional::energy(const Configuration& u) const { return sum(u, Want::energy, {}, nullptr); }
Evaluation Functional::gradient(const Configuration& u, std::span<double> g) const { return sum(u, Want::gradient, g, nullptr); }
Evaluation Functional::hessian(const Configuration& u, std::span<double> g, BlockMatrix& h) const { return sum(u, Want::hessian, g, &h); }

EvaluationFailure Functional::failure(Trouble trouble, std::size_t term, int cell) const {
  return {trouble, static_cast<int>(term), terms_[term]->name(), middle(layout_->fields().front().space->mesh(), terms_[term]->cell(cell))};
}

/// The first cell whose derivatives are not finite although its energy is; where none is, a sum of finite numbers has overflowed, and the term with the largest
/// energy is blamed at its first cell.
EvaluationFailure Functional::find_not_finite(const Configuration& u, Want want) const {
  BatchResult out;
  std::size_t largest = 0;
  double most = -1;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Term& term = *terms_[k];
    double energy = 0;
    for (int b = 0; b < term.batch_count(); ++b) {
      const Batch& batch = term.batch(b);
      std::size_t n = 0;
      for (const LocalBlock& block : *batch.blocks) n += static_cast<std::size_t>(block.dim);
      out.gradient.assign(want == Want::energy ? 0 : n * W, 0.0);
      out.hessian.assign(want == Want::hessian ? n * n * W : 0, 0.0);
      term.evaluate(u, b, want, out);
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch.cells_used); ++lane) {
        energy += std::abs(out.energy[lane]);
        double zero = 0;  // x * 0 is 0 for finite x only
        for (std::size_t i = lane; i < out.gradient.size(); i += W) zero += out.gradient[i] * 0;
        for (std::size_t i = lane; i < out.hessian.size(); i += W) zero += out.hessian[i] * 0;
        if (!(zero == 0)) return failure(Trouble::not_finite, k, batch.cells[lane]);
      }
    }
    if (energy > most && term.batch_count() > 0) {
      largest = k;
      most = energy;
    }
  }
  return failure(Trouble::not_finite, largest, terms_[largest]->batch(0).cells[0]);
}

Evaluation Functional::sum(const Configuration& u, Want want, std::span<double> g, BlockMatrix* h) const {
  std::fill(g.begin(), g.end(), 0.0);
  if (h) std::fill(h->values.begin(), h->values.end(), 0.0);
  const int bs = layout_->block_size();

  Evaluation result;
  result.terms.assign(terms_.size(), 0.0);
  BatchResult out;
  std::size_t next_scatter = 0;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Term& term = *terms_[k];
    for (int b = 0; b < term.batch_count(); ++b) {
      const Scatter& scatter = *scatter_[next_scatter++];
      const Batch& batch = term.batch(b);
      const auto n = static_cast<std::size_t>(scatter.unknowns);
      if (want != Want::energy) out.gradient.resize(n * W);
      if (want == Want::hessian) out.hessian.resize(n * n * W);
      out.trouble.fill(Trouble::none);
      term.evaluate(u, b, want, out);

      const auto used = static_cast<std::size_t>(batch.cells_used);
      for (std::size_t lane = 0; lane < used; ++lane) {
        if (out.trouble[lane] == Trouble::none && !std::isfinite(out.energy[lane])) out.trouble[lane] = Trouble::not_finite;
        if (out.trouble[lane] != Trouble::none) {
          result.failure = failure(out.trouble[lane], k, batch.cells[lane]);
          result.energy = std::numeric_limits<double>::infinity();
          return result;
        }
        result.terms[k] += out.energy[lane];
      }
      if (want == Want::energy) continue;

      for (std::size_t p = 0; p < scatter.pieces.size(); ++p) {
        const Piece& piece = scatter.pieces[p];
        const double* source = out.gradient.data() + static_cast<std::size_t>(piece.begin) * W;
        for (std::size_t lane = 0; lane < used; ++lane)
          for (std::size_t c = 0; c < static_cast<std::size_t>(piece.size); ++c)
            g[static_cast<std::size_t>(scatter.dofs[p][lane]) + c] += source[c * W + lane];
      }
      if (want != Want::hessian) continue;

      std::size_t pair = 0;
      for (std::size_t i = 0; i < scatter.pieces.size(); ++i)
        for (std::size_t j = i; j < scatter.pieces.size(); ++j, ++pair) {
          const Piece &pi = scatter.pieces[i], &pj = scatter.pieces[j];
          const double* source = out.hessian.data() + (static_cast<std::size_t>(pi.begin) * n + static_cast<std::size_t>(pj.begin)) * W;
          const auto rows = static_cast<std::size_t>(pi.size), columns = static_cast<std::size_t>(pj.size);
          for (std::size_t lane = 0; lane < used; ++lane) {
            const Scatter::Target& target = scatter.targets[pair][lane];
            double* to = h->values.data() + target.position;
            const auto by_row = static_cast<std::size_t>(target.transposed ? bs : 1),
                       by_column = static_cast<std::size_t>(target.transposed ? 1 : bs);
            const auto add = [&](std::size_t nr, std::size_t nc) {
              for (std::size_t r = 0; r < nr; ++r)
                for (std::size_t c = 0; c < nc; ++c) to[r * by_row + c * by_column] += source[(r * n + c) * W + lane];
            };
            if (rows == 3 && columns == 3)
              add(3, 3);
            else
              add(rows, columns);
            if (target.both) {  // mirror inside the diagonal block
              double* block = h->values.data() + target.position - target.position % (bs * bs);
              const auto place = static_cast<std::size_t>(target.position % (bs * bs));
              const std::size_t r0 = place % static_cast<std::size_t>(bs), c0 = place / static_cast<std::size_t>(bs);
              for (std::size_t r = 0; r < rows; ++r)
                for (std::size_t c = 0; c < columns; ++c) block[(r0 + r) * static_cast<std::size_t>(bs) + c0 + c] += source[(r * n + c) * W + lane];
            }
          }
        }
    }
    result.energy += result.terms[k];
  }
  // A finite energy with derivatives that are not: x * 0 is 0 for finite x only.
  double zero = 0;
  for (double x : g) zero += x * 0;
  if (h)
    for (double x : h->values) zero += x * 0;
  if (!(zero == 0) || !std::isfinite(result.energy)) {
    result.failure = find_not_finite(u, want);
    result.energy = std::numeric_limits<double>::infinity();
  }
  return result;
}

}  // namespace karcher
