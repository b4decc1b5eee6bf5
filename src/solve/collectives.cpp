#include "karcher/solve/collectives.hpp"

#include <petscsys.h>

#include <algorithm>
#include <vector>

#include "karcher/solve/petsc.hpp"

namespace karcher {

void sum_over_ranks(std::span<double> values) {
  const auto ranks = static_cast<std::size_t>(world_size());
  if (ranks == 1) return;
  // MPI_Allreduce may add in any order. Long arrays go in pieces, or every rank would hold all ranks' arrays at once.
  constexpr std::size_t longest = 1 << 15;
  std::vector<double> all(std::min(values.size(), longest) * ranks);
  for (std::size_t begin = 0; begin < values.size(); begin += longest) {
    const std::span<double> piece = values.subspan(begin, std::min(longest, values.size() - begin));
    const int n = static_cast<int>(piece.size());
    MPI_Allgather(piece.data(), n, MPI_DOUBLE, all.data(), n, MPI_DOUBLE, PETSC_COMM_WORLD);
    for (std::size_t i = 0; i < piece.size(); ++i) {
      piece[i] = 0;
      for (std::size_t r = 0; r < ranks; ++r) piece[i] += all[r * piece.size() + i];
    }
  }
}

double sum_over_ranks(double x) {
  sum_over_ranks({&x, 1});
  return x;
}

double max_over_ranks(double x) {
  double all = x;
  if (world_size() > 1) MPI_Allreduce(&x, &all, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return all;
}

bool on_any_rank(bool x) {
  int mine = x, all = x;
  if (world_size() > 1) MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return all != 0;
}

void take_from_first_rank(std::span<double> values) {
  if (world_size() > 1) MPI_Bcast(values.data(), static_cast<int>(values.size()), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
}

std::string first_text(const std::string& text) {
  const int ranks = world_size();
  int mine = text.empty() ? ranks : world_rank(), first = mine;
  if (ranks > 1) MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  if (first == ranks) return {};
  std::string result = text;
  int size = static_cast<int>(result.size());
  MPI_Bcast(&size, 1, MPI_INT, first, PETSC_COMM_WORLD);
  result.resize(static_cast<std::size_t>(size));
  MPI_Bcast(result.data(), size, MPI_CHAR, first, PETSC_COMM_WORLD);
  return result;
}

}  // namespace karcher
