#include "solve/star_forest.hpp"

#include <petscsf.h>

#include <algorithm>

#include "karcher/solve/petsc.hpp"
#include "solve/check_petsc.hpp"

namespace karcher {

struct StarForest::Graph {
  PetscSF forest = nullptr;
  MPI_Datatype entry = MPI_DATATYPE_NULL;
  int width = 1;
  std::vector<int> root_of;  ///< of every contribution, in the order in which PetscSFGather brings them: root after root, rank after rank

  Graph() = default;
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  ~Graph() {
    PetscBool over = PETSC_FALSE;
    if (PetscFinalized(&over) || over) return;
    PetscSFDestroy(&forest);
    if (entry != MPI_DATATYPE_NULL) MPI_Type_free(&entry);
  }
};

StarForest::StarForest(std::span<const int> leaves, const std::vector<int>& offsets, int width) {
  const auto graph = std::make_shared<Graph>();
  const auto rank = static_cast<std::size_t>(world_rank());
  const int roots = offsets[rank + 1] - offsets[rank];
  std::vector<PetscSFNode> remote;
  for (const int leaf : leaves) {
    const auto owner = std::upper_bound(offsets.begin(), offsets.end(), leaf) - offsets.begin() - 1;
    remote.push_back({static_cast<PetscInt>(owner), leaf - offsets[static_cast<std::size_t>(owner)]});
  }
  graph->width = width;
  MPI_Type_contiguous(width, MPI_DOUBLE, &graph->entry);
  MPI_Type_commit(&graph->entry);
  check_petsc(PetscSFCreate(PETSC_COMM_WORLD, &graph->forest));
  check_petsc(
      PetscSFSetGraph(graph->forest, roots, static_cast<PetscInt>(remote.size()), nullptr, PETSC_COPY_VALUES, remote.data(), PETSC_COPY_VALUES));
  check_petsc(PetscSFSetRankOrder(graph->forest, PETSC_TRUE));
  const PetscInt* degrees = nullptr;
  check_petsc(PetscSFComputeDegreeBegin(graph->forest, &degrees));
  check_petsc(PetscSFComputeDegreeEnd(graph->forest, &degrees));
  for (int i = 0; i < roots; ++i) graph->root_of.insert(graph->root_of.end(), static_cast<std::size_t>(degrees[i]), i);
  graph_ = graph;
}

void StarForest::copy_to_leaves(const double* roots, double* leaves) const {
  check_petsc(PetscSFBcastBegin(graph_->forest, graph_->entry, roots, leaves, MPI_REPLACE));
  check_petsc(PetscSFBcastEnd(graph_->forest, graph_->entry, roots, leaves, MPI_REPLACE));
}

void StarForest::copy_to_roots(const double* leaves, double* roots) const {
  check_petsc(PetscSFReduceBegin(graph_->forest, graph_->entry, leaves, roots, MPI_REPLACE));
  check_petsc(PetscSFReduceEnd(graph_->forest, graph_->entry, leaves, roots, MPI_REPLACE));
}

void StarForest::add_to_roots(const double* leaves, double* roots) const {
  // PetscSFReduce would add in the order of arrival: gathered, the contributions to a root stand in the order of the ranks.
  const auto width = static_cast<std::size_t>(graph_->width);
  std::vector<double> contributions(graph_->root_of.size() * width);
  check_petsc(PetscSFGatherBegin(graph_->forest, graph_->entry, leaves, contributions.data()));
  check_petsc(PetscSFGatherEnd(graph_->forest, graph_->entry, leaves, contributions.data()));
  const double* next = contributions.data();
  for (const int root : graph_->root_of)
    for (std::size_t k = 0; k < width; ++k) roots[static_cast<std::size_t>(root) * width + k] += *next++;
}

}  // namespace karcher
