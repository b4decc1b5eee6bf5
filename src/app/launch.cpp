#include "app/launch.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "karcher/error.hpp"

namespace karcher::app {
namespace {

constexpr const char* status_variable = "KARCHER_LAUNCH_STATUS";
constexpr const char* terminal_variable = "KARCHER_LAUNCH_TERMINAL";

volatile pid_t launched = 0;
volatile std::sig_atomic_t interrupts = 0;

// The ranks see SIGUSR1, which mpiexec passes on; SIGINT would make it kill them.
extern "C" void pass_on(int) {
  interrupts = interrupts + 1;
  if (launched > 0) kill(launched, interrupts == 1 ? SIGUSR1 : SIGTERM);
  if (interrupts > 2 && launched > 0) kill(-launched, SIGKILL);
}

std::string find_program(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    std::string rest = path ? path : "/usr/bin:/bin";
    while (!rest.empty()) {
      const std::size_t colon = rest.find(':');
      const std::string candidate = rest.substr(0, colon) + "/" + name;
      if (access(candidate.c_str(), X_OK) == 0) return candidate;
      rest = colon == std::string::npos ? std::string() : rest.substr(colon + 1);
    }
  }
  throw Error("Several ranks need mpiexec, which is not in the PATH; install the package openmpi-bin.");
}

/// Open MPI's mpiexec takes options that others refuse.
bool is_open_mpi(const std::string& program) {
  std::error_code code;
  const std::string real = std::filesystem::canonical(program, code).filename().string();
  return real.find("orte") != std::string::npos || real.find("prte") != std::string::npos || real.find("openmpi") != std::string::npos;
}

}  // namespace

bool under_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "MPI_LOCALRANKID"})
    if (std::getenv(name)) return true;
  // srun without PMI sets its own; inside a batch script there is a job, but no step of several tasks.
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  return tasks && std::atoi(tasks) > 1;
}

std::optional<int> launch_ranks(int ranks, int argc, char** argv) {
  if (ranks <= 1 || under_launcher()) return {};
  const std::string mpiexec = find_program({"mpiexec", "mpirun"});
  std::vector<std::string> command{mpiexec};
  if (is_open_mpi(mpiexec)) command.insert(command.end(), {"--oversubscribe", "--quiet", "--bind-to", "none"});
  command.insert(command.end(), {"-n", std::to_string(ranks), std::filesystem::canonical("/proc/self/exe").string()});
  for (int i = 1; i < argc; ++i) command.emplace_back(argv[i]);

  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  std::string status_file = (folder / "karcher-XXXXXX").string();  // mkstemp writes the name
  const int descriptor = mkstemp(status_file.data());
  if (descriptor < 0) throw Error(fmt::format("No temporary file can be made in {}: {}.", folder.string(), std::strerror(errno)));
  close(descriptor);

  std::vector<char*> arguments;
  for (std::string& s : command) arguments.push_back(s.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw Error(fmt::format("mpiexec cannot be started: {}.", std::strerror(errno)));
  if (child == 0) {
    setenv(status_variable, status_file.c_str(), 1);
    setenv(terminal_variable, isatty(STDOUT_FILENO) ? "1" : "0", 1);
    // Open MPI refuses to run as root, as one does in containers, unless both are set.
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
    // A group of its own: Ctrl-C on the terminal reaches this launcher only. It must not outlive it.
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (!std::freopen("/dev/null", "r", stdin)) _exit(127);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  launched = child;
  struct sigaction action {};
  action.sa_handler = pass_on;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);

  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  int told = -1;
  std::ifstream(status_file) >> told;
  std::filesystem::remove(status_file);
  if (told >= 0) return told;
  if (interrupts > 0) return 130;
  if (WIFSIGNALED(status)) return 3;
  const int code = WEXITSTATUS(status);
  return code == 0 ? 3 : code;  // ranks that ended without a word have crashed
}

int report_exit(int code) {
  const char* file = std::getenv(status_variable);
  if (!file) return code;
  // The file is there before the ranks are; all of them write the same.
  std::ofstream(file) << code << "\n";
  return 0;
}

bool on_terminal() {
  const char* told = std::getenv(terminal_variable);
  if (told) return told[0] == '1';
  return !under_launcher() && isatty(STDOUT_FILENO) != 0;
}

}  // namespace karcher::app
