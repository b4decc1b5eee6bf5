// Problem files: what `karcher check` does with them, on meshes of at most some thousand cells, in a directory that holds the file and one small mesh.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "app/problem_file.hpp"
#include "fuzz/fuzzing.hpp"
#include "karcher/problem/discrete_problem.hpp"
#include "karcher/solve/petsc.hpp"
#include "temporary_directory.hpp"

namespace {
bool limited = false;
}  // namespace

/// The program sees little memory (karcher/memory.hpp asks for the limit of the address space), so that it refuses the meshes that would take long. A limit of the
/// system's would stop the sanitizers.
extern "C" int getrlimit(__rlimit_resource_t resource, rlimit* limit) noexcept {
  const int result = ::prlimit(0, static_cast<__rlimit_resource>(resource), nullptr, limit);
  if (limited && result == 0 && resource == RLIMIT_AS) limit->rlim_cur = 3'000'000;
  return result;
}

namespace {

/// MPI reports crashes in its own way, and so takes them from libFuzzer, which must keep the input.
void start_session() {
  constexpr std::array signals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  std::array<struct sigaction, signals.size()> before{};
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], nullptr, &before[i]);
  static const karcher::PetscSession session;
  for (std::size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &before[i], nullptr);
}

/// Files outside the directory are left alone: a text that could name one, plainly or by an escape, loses its slashes.
std::string without_foreign_paths(std::string_view text) {
  std::string copy(text);
  if (text.find("file") != std::string_view::npos || text.find('\\') != std::string_view::npos) std::replace(copy.begin(), copy.end(), '/', '_');
  for (std::size_t at; (at = copy.find("2f")) != std::string::npos || (at = copy.find("2F")) != std::string::npos;) copy[at + 1] = '_';
  return copy;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  start_session();
  limited = true;
  return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace karcher;
  static const TemporaryDirectory directory;
  static const bool prepared = [] {
    std::ofstream(directory / "two.msh") << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 1 \"rim\"\n$EndPhysicalNames\n"
                                            "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
                                            "$Elements\n3\n1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 4\n3 1 2 1 1 1 2\n$EndElements\n";
    return true;
  }();
  static_cast<void>(prepared);
  const std::filesystem::path file = directory / "problem.toml";
  std::ofstream(file) << without_foreign_paths(fuzzing::text_of(data, size));
  fuzzing::take_or_refuse([&] {
    const Problem problem = app::read_problem(file);
    const DiscreteProblem model = build(problem, build_mesh(problem));
    rehearse(problem, model);
  });
  return 0;
}
