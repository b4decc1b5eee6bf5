#include "karcher/field/layout.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "karcher/error.hpp"

namespace karcher {
namespace {

std::span<const int> vertices_of(const NodeKey& key) {
  const auto end = std::find(key.vertices.begin(), key.vertices.end(), -1);
  return {key.vertices.data(), static_cast<std::size_t>(end - key.vertices.begin())};
}

/// Unknowns at one place of the mesh.
struct Group {
  int dim = 0;
  int owner = 0;
  bool seen = false;                         ///< by this rank
  std::vector<std::pair<int, int>> members;  ///< (field, node)
};

/// Size of the matrix blocks: the unknowns of a place if it is the same everywhere, else what divides the unknowns of every field.
int common_block_size(std::span<const Field> fields, const std::vector<Group>& groups) {
  const auto same = [&](const Group& g) { return g.dim == groups.front().dim; };
  if (std::all_of(groups.begin(), groups.end(), same)) return groups.front().dim;
  int divisor = 0;
  for (const Field& f : fields) divisor = std::gcd(divisor, f.manifold->dim);
  return divisor;
}

}  // namespace

Layout::Layout(std::span<const Field> fields, const std::vector<std::vector<char>>& fixed, const CellRanks& cell_ranks, int rank, int ranks)
    : fields_(fields.begin(), fields.end()), rank_(rank), ranks_(ranks) {
  if (fields_.empty()) throw InputError("A problem needs at least one field.");
  cell_ranks_ = cell_ranks;
  around_ = std::make_shared<VertexCells>(fields_.front().space->mesh(), fields_.front().space->mesh().first_copies);

  std::vector<std::tuple<NodeKey, int, int>> places;
  for (std::size_t f = 0; f < fields_.size(); ++f)
    for (int n = 0; n < fields_[f].space->node_count(); ++n) places.emplace_back(fields_[f].space->key(n), static_cast<int>(f), n);
  std::sort(places.begin(), places.end());

  std::vector<Group> groups;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [key, field, node] = places[i];
    if (i == 0 || key != std::get<0>(places[i - 1])) {
      Group& g = groups.emplace_back();
      std::vector<int> touching;
      around_->containing(vertices_of(key), [&](int c) {
        touching.push_back(ranks_ == 1 ? 0 : cell_ranks_[static_cast<std::size_t>(c)]);
        return ranks_ > 1;
      });
      if (touching.empty()) throw Error("A node of a field belongs to no cell of the mesh.");
      std::sort(touching.begin(), touching.end());
      touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
      g.owner = touching[groups.size() % touching.size()];
      g.seen = std::binary_search(touching.begin(), touching.end(), rank_);
    }
    groups.back().members.emplace_back(field, node);
    groups.back().dim += fields_[static_cast<std::size_t>(field)].manifold->dim;
  }
  block_size_ = common_block_size(fields, groups);

  // Within a rank, places follow the order in which the nodes of the spaces appear: neighbours in the mesh are neighbours in memory.
  std::vector<int> order(groups.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const Group &ga = groups[static_cast<std::size_t>(a)], &gb = groups[static_cast<std::size_t>(b)];
    return std::tuple(ga.owner, ga.members.front().second, ga.members.front().first) <
           std::tuple(gb.owner, gb.members.front().second, gb.members.front().first);
  });

  owner_.resize(fields_.size());
  first_dof_.resize(fields_.size());
  local_nodes_.resize(fields_.size());
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    owner_[f].assign(static_cast<std::size_t>(fields_[f].space->node_count()), 0);
    first_dof_[f].assign(static_cast<std::size_t>(fields_[f].space->node_count()), -1);
  }

  struct Placed {
    int group, block;
  };
  std::vector<Placed> owned, ghosts;
  int next_block = 0;
  for (int g : order) {
    const Group& group = groups[static_cast<std::size_t>(g)];
    if (group.owner == rank_) {
      if (owned.empty()) owned_begin_ = next_block;
      owned.push_back({g, next_block});
    } else if (group.seen) {
      ghosts.push_back({g, next_block});
    } else if (owned.empty()) {
      owned_begin_ = next_block + group.dim / block_size_;
    }
    next_block += group.dim / block_size_;
  }
  global_blocks_ = next_block;
  if (owned.empty()) {  // a rank without unknowns: its empty range starts where the next rank's would
    owned_begin_ = 0;
    for (const Group& g : groups)
      if (g.owner < rank_) owned_begin_ += g.dim / block_size_;
  }

  const auto place = [&](const Placed& p) {
    int dof = static_cast<int>(local_to_global_.size()) * block_size_;
    const Group& group = groups[static_cast<std::size_t>(p.group)];
    for (int b = 0; b < group.dim / block_size_; ++b) local_to_global_.push_back(p.block + b);
    for (const auto& [field, node] : group.members) {
      const auto f = static_cast<std::size_t>(field);
      first_dof_[f][static_cast<std::size_t>(node)] = dof;
      local_nodes_[f].push_back(node);
      dof += fields_[f].manifold->dim;
    }
  };
  for (const Placed& p : owned) place(p);
  owned_blocks_ = static_cast<int>(local_to_global_.size());
  for (const Placed& p : ghosts) place(p);
  for (auto& nodes : local_nodes_) std::sort(nodes.begin(), nodes.end());

  for (const Group& g : groups)
    for (const auto& [field, node] : g.members) {
      const auto f = static_cast<std::size_t>(field);
      owner_[f][static_cast<std::size_t>(node)] = g.owner;
    }
  fix(fixed);
}

void Layout::fix(const std::vector<std::vector<char>>& fixed) {
  fixed_.assign(static_cast<std::size_t>(local_dofs()), 0);
  free_dofs_ = 0;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const auto dim = static_cast<std::size_t>(fields_[f].manifold->dim);
    for (std::size_t node = 0; node < first_dof_[f].size(); ++node)
      for (std::size_t k = 0; k < dim; ++k) {
        const std::size_t entry = node * dim + k;
        const bool held = entry < fixed[f].size() && fixed[f][entry];
        free_dofs_ += !held;
        if (held && first_dof_[f][node] >= 0) fixed_[static_cast<std::size_t>(first_dof_[f][node]) + k] = 1;
      }
  }
}

int Layout::cell_rank(const Cell& entity) const {
  if (ranks_ == 1) return 0;
  int rank = -1;
  around_->containing(vertices(entity), [&](int c) {
    rank = cell_ranks_[static_cast<std::size_t>(c)];
    return false;
  });
  if (rank >= 0) return rank;
  throw Error("An entity of a region belongs to no cell of the mesh.");
}

void Layout::retract(const Configuration& from, std::span<const double> step, Configuration& trial) const {
  trial.t = from.t;
  std::vector<double> v;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const ManifoldOps& manifold = *fields_[f].manifold;
    v.resize(static_cast<std::size_t>(manifold.dim));
    for (int node : local_nodes_[f]) {
      const auto dof = static_cast<std::size_t>(first_dof(static_cast<int>(f), node));
      for (std::size_t k = 0; k < v.size(); ++k) v[k] = fixed_[dof + k] ? 0.0 : step[dof + k];
      manifold.retract(from.at(static_cast<int>(f), node, manifold.ambient), v.data(), trial.at(static_cast<int>(f), node, manifold.ambient));
    }
  }
}

}  // namespace karcher
