#include "solve/ldlt.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "karcher/error.hpp"
#include "karcher/mesh/partition.hpp"
#include "karcher/solve/collectives.hpp"
#include "karcher/solve/petsc.hpp"
#include "karcher/solve/together.hpp"
#include "solve/star_forest.hpp"

namespace karcher {
namespace {

/// Neighbours of every block over all ranks, on rank 0 (elsewhere empty).
Graph gather_block_graph(const Exchange& exchange, const BlockMatrix& m) {
  std::vector<int> pairs;
  const std::vector<int>& global = exchange.local_to_global();
  for (std::size_t i = 0; i + 1 < m.row_begin.size(); ++i)
    for (int k = m.row_begin[i]; k < m.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(m.column[static_cast<std::size_t>(k)]);
      if (i != j) pairs.insert(pairs.end(), {global[i], global[j]});
    }
  if (exchange.ranks() > 1) {
    const int mine = static_cast<int>(pairs.size());
    std::vector<int> counts(static_cast<std::size_t>(exchange.ranks())), begin(counts.size() + 1, 0);
    MPI_Gather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, PETSC_COMM_WORLD);
    for (std::size_t r = 0; r < counts.size(); ++r) begin[r + 1] = begin[r] + counts[r];
    std::vector<int> all(exchange.rank() == 0 ? static_cast<std::size_t>(begin.back()) : 0);
    MPI_Gatherv(pairs.data(), mine, MPI_INT, all.data(), counts.data(), begin.data(), MPI_INT, 0, PETSC_COMM_WORLD);
    pairs.swap(all);
  }
  Graph graph;
  if (exchange.rank() != 0) return graph;
  const auto n = static_cast<std::size_t>(exchange.offsets().back());
  std::vector<std::vector<int>> neighbours(n);
  for (std::size_t k = 0; k < pairs.size(); k += 2) {
    neighbours[static_cast<std::size_t>(pairs[k])].push_back(pairs[k + 1]);
    neighbours[static_cast<std::size_t>(pairs[k + 1])].push_back(pairs[k]);
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    graph.adjacent.insert(graph.adjacent.end(), list.begin(), list.end());
    graph.begin.push_back(static_cast<int>(graph.adjacent.size()));
  }
  return graph;
}

}  // namespace

struct Ldlt::Mumps {
  DMUMPS_STRUC_C id{};
  std::vector<int> row, column, permutation;
  std::vector<std::int64_t> source;  ///< place in BlockMatrix::values
  std::vector<double> values;        ///< entries of the matrix, then the diagonal of the owned dofs
  std::vector<double> sides;         ///< right-hand sides: on owned dofs, column after column; on one rank solutions, too
  long factorisations = 0;
  bool alive = false;

  // Several ranks: MUMPS leaves an entry of the solution where its pivot is.
  std::vector<int> owned;          ///< the rows of the owned dofs, from 1
  std::vector<int> offsets;        ///< first owned dof of every rank, and the number of all
  std::vector<int> solved;         ///< rows, from 1, of the entries that this rank gets
  std::vector<double> solution;    ///< their values, column after column
  std::optional<StarForest> home;  ///< from there to the owners
  std::vector<int> home_is_of;     ///< the rows for which it was made
  bool pivots_are_new = true;      ///< since `home` was looked at

  int& control(int i) { return id.icntl[i - 1]; }
  int info(int i) const { return id.infog[i - 1]; }
  void call(int job) {
    id.job = job;
    dmumps_c(&id);
  }
  /// INFOG is the same on all ranks.
  void require(const char* what) const {
    if (info(1) >= 0) return;
    // Allocations that failed (in the analysis -5, -7), and room for delayed pivots that was doubled in vain (-8, -9).
    constexpr std::array<int, 5> of_memory = {-5, -7, -8, -9, -13};
    if (std::count(of_memory.begin(), of_memory.end(), info(1)) > 0)
      throw SharedError(fmt::format("There is not enough memory to {} a matrix of {} unknowns (MUMPS {}, {}).", what, id.n, info(1), info(2)));
    throw SharedError(fmt::format("MUMPS could not {} a matrix of {} unknowns: INFOG(1) = {}, INFOG(2) = {}.", what, id.n, info(1), info(2)));
  }
};

Ldlt::Ldlt(const Exchange& exchange, const BlockMatrix& pattern, std::vector<char> fixed)
    : exchange_(exchange), fixed_(std::move(fixed)), mumps_(std::make_unique<Mumps>()) {
  Mumps& m = *mumps_;
  const int bs = pattern.block_size;
  const std::vector<int>& global = exchange.local_to_global();
  const auto add = [&](std::size_t i, std::size_t j, int r, int c, std::int64_t source) {
    if (fixed_[i * static_cast<std::size_t>(bs) + static_cast<std::size_t>(r)] ||
        fixed_[j * static_cast<std::size_t>(bs) + static_cast<std::size_t>(c)])
      return;
    m.row.push_back(global[i] * bs + r + 1);
    m.column.push_back(global[j] * bs + c + 1);
    m.source.push_back(source);
  };
  for (std::size_t i = 0; i + 1 < pattern.row_begin.size(); ++i)
    for (int k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(k)]);
      const std::int64_t at = static_cast<std::int64_t>(k) * bs * bs;
      for (int c = 0; c < bs; ++c)
        for (int r = 0; r < (i == j ? c + 1 : bs); ++r) add(i, j, r, c, at + c * bs + r);
    }
  for (int d = 0; d < exchange.owned_dofs(); ++d) {
    m.row.push_back(exchange.owned_begin() * bs + d + 1);
    m.column.push_back(m.row.back());
  }
  m.values.assign(m.row.size(), 0.0);
  m.owned.assign(m.row.end() - exchange.owned_dofs(), m.row.end());
  for (const int block : exchange.offsets()) m.offsets.push_back(block * bs);

  const Graph graph = gather_block_graph(exchange, pattern);
  if (exchange.rank() == 0)
    for (int place : fill_reducing_order(graph))
      for (int r = 0; r < bs; ++r) m.permutation.push_back(place * bs + r + 1);

  m.id.par = 1;
  m.id.sym = 2;  // symmetric, indefinite: 1x1 and 2x2 pivots
  m.id.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(PETSC_COMM_WORLD));
  m.call(-1);
  m.require("start on");
  m.alive = true;
  for (int output : {1, 2, 3}) m.control(output) = -1;
  m.control(4) = 0;
  m.control(6) = 0;    // no permutation to a better diagonal: it is good
  m.control(12) = 1;   // and no compression for it
  m.control(13) = 1;   // no ScaLAPACK for the root: it would lose the inertia
  m.control(14) = 25;  // per cent of room for delayed pivots, to begin with
  m.control(24) = 1;   // find null pivots
  m.id.n = exchange.global_dofs();
  const auto entries = static_cast<MUMPS_INT8>(m.values.size());
  if (exchange.ranks() == 1) {
    m.id.nnz = entries;
    m.id.irn = m.row.data();
    m.id.jcn = m.column.data();
    m.id.a = m.values.data();
  } else {
    m.control(18) = 3;
    m.id.nnz_loc = entries;
    m.id.irn_loc = m.row.data();
    m.id.jcn_loc = m.column.data();
    m.id.a_loc = m.values.data();
    m.control(20) = 10;  // distributed right-hand sides
    m.control(21) = 1;   // and solutions
    m.id.nloc_rhs = m.id.lrhs_loc = exchange.owned_dofs();
    m.id.irhs_loc = m.owned.data();
  }
  m.id.perm_in = m.permutation.data();
  const auto analyse = [&](int order) {
    m.control(7) = order;
    m.call(1);
    m.require("analyse");
    return m.id.rinfog[0];
  };
  // Minimum degree often wins on small surfaces, nested dissection on large ones and in 3D, and it alone gives the ranks independent work.
  constexpr int minimum_degree = 0, given = 1;
  const double other = exchange.ranks() == 1 ? analyse(minimum_degree) : 0;
  if (analyse(given) > other && exchange.ranks() == 1) analyse(minimum_degree);
}

Ldlt::~Ldlt() {
  int over = 0;
  MPI_Finalized(&over);
  if (mumps_->alive && !over) mumps_->call(-2);
}

Inertia Ldlt::factor(const BlockMatrix& h, double shift, std::span<const double> mass) {
  Mumps& m = *mumps_;
  for (std::size_t k = 0; k < m.source.size(); ++k) m.values[k] = h.values[static_cast<std::size_t>(m.source[k])];
  for (std::size_t d = 0; d < static_cast<std::size_t>(exchange_.owned_dofs()); ++d)
    m.values[m.source.size() + d] = fixed_[d] ? 1.0 : shift * mass[d];
  const auto factorise = [&] {
    ++m.factorisations;
    m.call(2);
    return m.info(1) != -8 && m.info(1) != -9;  // else there were more delayed pivots than there is room for
  };
  for (int tries = 0; !factorise() && tries < 6; ++tries) m.control(14) *= 2;
  m.require("factorise");
  m.pivots_are_new = true;
  return {m.info(12), m.info(28)};
}

long Ldlt::factorisations() const { return mumps_->factorisations; }

void Ldlt::solve(std::span<const double> b, std::span<double> x, int count) {
  Mumps& m = *mumps_;
  const auto owned = static_cast<std::size_t>(exchange_.owned_dofs()), local = static_cast<std::size_t>(exchange_.local_dofs());
  const auto columns = static_cast<std::size_t>(count);
  m.sides.resize(owned * columns);
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t d = 0; d < owned; ++d) m.sides[c * owned + d] = fixed_[d] ? 0 : b[c * local + d];
  m.id.nrhs = count;
  if (exchange_.ranks() == 1) {
    m.id.rhs = m.sides.data();
    m.id.lrhs = m.id.n;
    m.call(3);
    m.require("solve with");
    std::copy(m.sides.begin(), m.sides.end(), x.begin());
    return;
  }
  const auto held = static_cast<std::size_t>(m.id.info[22]);
  m.solved.resize(held);
  m.solution.resize(held * columns);
  m.id.rhs_loc = m.sides.data();
  m.id.isol_loc = m.solved.data();
  m.id.sol_loc = m.solution.data();
  m.id.lsol_loc = static_cast<MUMPS_INT>(held);
  m.call(3);
  m.require("solve with");
  if (m.pivots_are_new && on_any_rank(!m.home || m.solved != m.home_is_of)) {
    std::vector<int> entries;
    for (const int row : m.solved) entries.push_back(row - 1);
    m.home.emplace(entries, m.offsets, 1);
    m.home_is_of = m.solved;
  }
  m.pivots_are_new = false;
  for (std::size_t c = 0; c < columns; ++c) {
    const std::span<double> column = x.subspan(c * local, local);
    m.home->copy_to_roots(m.solution.data() + c * held, column.data());
    exchange_.update_ghosts(column);
  }
}

}  // namespace karcher
