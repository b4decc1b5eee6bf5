#include "karcher/solve/exchange.hpp"

#include <petscsys.h>

#include <algorithm>
#include <numeric>

#include "karcher/solve/petsc.hpp"

namespace karcher {
namespace {

std::vector<int> begins(const std::vector<int>& counts) {
  std::vector<int> begin(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), begin.begin() + 1);
  return begin;
}

}  // namespace

Exchange::Exchange(const Layout& layout) : Exchange(layout.block_size(), layout.owned_begin(), layout.owned_blocks(), layout.local_to_global()) {}

Exchange::Exchange(int block_size, int owned_begin, int owned_blocks, std::vector<int> local_to_global)
    : block_size_(block_size), owned_begin_(owned_begin), owned_blocks_(owned_blocks), local_to_global_(std::move(local_to_global)) {
  rank_ = world_rank();
  ranks_ = world_size();
  connect();
}

void Exchange::connect() {
  const auto n = static_cast<std::size_t>(ranks_);
  std::vector<int> owned(n);
  MPI_Allgather(&owned_blocks_, 1, MPI_INT, owned.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  offsets_ = begins(owned);
  global_blocks_ = offsets_.back();

  std::vector<std::pair<int, int>> ghosts;  // global block, local block: by owner, since owners have ranges
  for (std::size_t i = static_cast<std::size_t>(owned_blocks_); i < local_to_global_.size(); ++i)
    ghosts.emplace_back(local_to_global_[i], static_cast<int>(i));
  std::sort(ghosts.begin(), ghosts.end());
  std::vector<int> wanted;
  ghost_counts_.assign(n, 0);
  for (const auto& [global, local] : ghosts) {
    const auto owner = std::upper_bound(offsets_.begin(), offsets_.end(), global) - offsets_.begin() - 1;
    ++ghost_counts_[static_cast<std::size_t>(owner)];
    ghost_blocks_.push_back(local);
    wanted.push_back(global);
  }
  ghost_begin_ = begins(ghost_counts_);

  shared_counts_.assign(n, 0);
  MPI_Alltoall(ghost_counts_.data(), 1, MPI_INT, shared_counts_.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  shared_begin_ = begins(shared_counts_);
  shared_blocks_.resize(static_cast<std::size_t>(shared_begin_.back()));
  MPI_Alltoallv(wanted.data(), ghost_counts_.data(), ghost_begin_.data(), MPI_INT, shared_blocks_.data(), shared_counts_.data(), shared_begin_.data(),
                MPI_INT, PETSC_COMM_WORLD);
  for (int& block : shared_blocks_) block -= owned_begin_;
  for (auto* v : {&ghost_counts_, &ghost_begin_, &shared_counts_, &shared_begin_})
    for (int& x : *v) x *= block_size_;
}

void Exchange::update_ghosts(std::span<double> v) const {
  if (ranks_ == 1) return;
  const auto bs = static_cast<std::size_t>(block_size_);
  std::vector<double> out(shared_blocks_.size() * bs), in(ghost_blocks_.size() * bs);
  for (std::size_t i = 0; i < shared_blocks_.size(); ++i)
    std::copy_n(v.data() + static_cast<std::size_t>(shared_blocks_[i]) * bs, bs, out.data() + i * bs);
  MPI_Alltoallv(out.data(), shared_counts_.data(), shared_begin_.data(), MPI_DOUBLE, in.data(), ghost_counts_.data(), ghost_begin_.data(), MPI_DOUBLE,
                PETSC_COMM_WORLD);
  for (std::size_t i = 0; i < ghost_blocks_.size(); ++i)
    std::copy_n(in.data() + i * bs, bs, v.data() + static_cast<std::size_t>(ghost_blocks_[i]) * bs);
}

void Exchange::sum(std::span<double> v) const {
  if (ranks_ == 1) return;
  const auto bs = static_cast<std::size_t>(block_size_);
  std::vector<double> out(ghost_blocks_.size() * bs), in(shared_blocks_.size() * bs);
  for (std::size_t i = 0; i < ghost_blocks_.size(); ++i)
    std::copy_n(v.data() + static_cast<std::size_t>(ghost_blocks_[i]) * bs, bs, out.data() + i * bs);
  MPI_Alltoallv(out.data(), ghost_counts_.data(), ghost_begin_.data(), MPI_DOUBLE, in.data(), shared_counts_.data(), shared_begin_.data(), MPI_DOUBLE,
                PETSC_COMM_WORLD);
  for (std::size_t i = 0; i < shared_blocks_.size(); ++i)  // rank after rank
    for (std::size_t k = 0; k < bs; ++k) v[static_cast<std::size_t>(shared_blocks_[i]) * bs + k] += in[i * bs + k];
  update_ghosts(v);
}

void Exchange::sum_all(std::span<double> values) const {
  if (ranks_ == 1) return;
  std::vector<double> all(values.size() * static_cast<std::size_t>(ranks_));
  const int n = static_cast<int>(values.size());
  MPI_Allgather(values.data(), n, MPI_DOUBLE, all.data(), n, MPI_DOUBLE, PETSC_COMM_WORLD);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 0;
    for (std::size_t r = 0; r < static_cast<std::size_t>(ranks_); ++r) values[i] += all[r * values.size() + i];
  }
}

double Exchange::sum(double x) const {
  sum_all({&x, 1});
  return x;
}

double Exchange::dot(std::span<const double> a, std::span<const double> b) const {
  double s = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(owned_dofs()); ++i) s += a[i] * b[i];
  return sum(s);
}

bool Exchange::any(bool x) const {
  int mine = x, all = x;
  if (ranks_ > 1) MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return all != 0;
}

double Exchange::max(double x) const {
  double all = x;
  if (ranks_ > 1) MPI_Allreduce(&x, &all, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return all;
}

std::string Exchange::first_text(const std::string& text) const {
  int mine = text.empty() ? ranks_ : rank_, first = mine;
  if (ranks_ > 1) MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  if (first == ranks_) return {};
  std::string result = text;
  int size = static_cast<int>(result.size());
  MPI_Bcast(&size, 1, MPI_INT, first, PETSC_COMM_WORLD);
  result.resize(static_cast<std::size_t>(size));
  MPI_Bcast(result.data(), size, MPI_CHAR, first, PETSC_COMM_WORLD);
  return result;
}

void complete(const Layout& layout, Configuration& u) {
  if (layout.ranks() == 1) return;
  for (std::size_t f = 0; f < layout.fields().size(); ++f) {
    const int ambient = layout.fields()[f].manifold->ambient, nodes = layout.fields()[f].space->node_count();
    const auto width = static_cast<std::size_t>(ambient);
    std::vector<double> out, in;
    std::vector<int> counts(static_cast<std::size_t>(layout.ranks()), 0);
    for (int node = 0; node < nodes; ++node) {
      const int owner = layout.owner(static_cast<int>(f), node);
      counts[static_cast<std::size_t>(owner)] += ambient;
      if (owner == layout.rank()) out.insert(out.end(), u.at(static_cast<int>(f), node, ambient), u.at(static_cast<int>(f), node, ambient) + width);
    }
    std::vector<int> begin = begins(counts);
    in.resize(static_cast<std::size_t>(begin.back()));
    MPI_Allgatherv(out.data(), static_cast<int>(out.size()), MPI_DOUBLE, in.data(), counts.data(), begin.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
    for (int node = 0; node < nodes; ++node) {
      int& next = begin[static_cast<std::size_t>(layout.owner(static_cast<int>(f), node))];
      std::copy_n(in.data() + next, width, u.at(static_cast<int>(f), node, ambient));
      next += ambient;
    }
  }
}

}  // namespace karcher
