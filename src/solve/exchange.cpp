#include "karcher/solve/exchange.hpp"

#include <petscsys.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "karcher/solve/collectives.hpp"
#include "karcher/solve/petsc.hpp"
#include "solve/star_forest.hpp"

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
    : rank_(world_rank()),
      ranks_(world_size()),
      block_size_(block_size),
      owned_begin_(owned_begin),
      owned_blocks_(owned_blocks),
      local_to_global_(std::move(local_to_global)) {
  std::vector<int> owned(static_cast<std::size_t>(ranks_), owned_blocks_);
  if (ranks_ > 1) MPI_Allgather(&owned_blocks_, 1, MPI_INT, owned.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  offsets_ = begins(owned);
  if (ranks_ > 1)
    ghosts_ = std::make_shared<StarForest>(std::span(local_to_global_).subspan(static_cast<std::size_t>(owned_blocks_)), offsets_, block_size_);
}

void Exchange::update_ghosts(std::span<double> v) const {
  if (ghosts_) ghosts_->copy_to_leaves(v.data(), v.data() + owned_dofs());
}

void Exchange::sum(std::span<double> v) const {
  if (!ghosts_) return;
  ghosts_->add_to_roots(v.data() + owned_dofs(), v.data());
  update_ghosts(v);
}

double Exchange::dot(std::span<const double> a, std::span<const double> b) const {
  double s = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(owned_dofs()); ++i) s += a[i] * b[i];
  return sum_over_ranks(s);
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
