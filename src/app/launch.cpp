#include "app/launch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "karcher/error.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

/// "PROCESS TERMINAL WORDS OUTPUT ERRORS": the launcher, whether its standard output is a terminal, and the descriptors of its pipes. Ranks are children of mpiexec's
/// daemon and inherit nothing; they open the pipes by their names in /proc.
constexpr const char* launcher_variable = "KARCHER_LAUNCHER";

struct Launcher {
  pid_t process = 0;
  bool terminal = false;
  int words = -1, output = -1, errors = -1;
  /// Opens the writing end of one of the pipes; -1 if that cannot be.
  int open(int descriptor) const { return ::open(fmt::format("/proc/{}/fd/{}", process, descriptor).c_str(), O_WRONLY | O_CLOEXEC); }
};

std::optional<Launcher> launcher() {
  const char* text = std::getenv(launcher_variable);
  if (!text) return {};
  Launcher l;
  std::istringstream(text) >> l.process >> l.terminal >> l.words >> l.output >> l.errors;
  return l;
}

/// A line is one write, which pipes do not tear. \returns whether there is somebody to be told
bool tell_launcher(const std::string& line) {
  const std::optional<Launcher> l = launcher();
  const int descriptor = l ? l->open(l->words) : -1;
  if (descriptor < 0) return false;
  const std::string text = line + "\n";
  const bool told = ::write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::close(descriptor);
  return told;
}

volatile pid_t mpiexec_process = 0;
volatile std::sig_atomic_t interrupts = 0;

// The ranks see SIGUSR1, which mpiexec passes on; SIGINT would make it kill them.
extern "C" void pass_on(int) {
  interrupts = interrupts + 1;
  if (mpiexec_process > 0) kill(mpiexec_process, interrupts == 1 ? SIGUSR1 : SIGTERM);
  if (interrupts > 2 && mpiexec_process > 0) kill(-mpiexec_process, SIGKILL);
}

extern "C" void wake_up(int) {}

void on_signal(int signal, void (*handler)(int)) {
  struct sigaction action {
  }, before{};
  sigaction(signal, nullptr, &before);
  if (signal == SIGHUP && before.sa_handler == SIG_IGN) return;  // nohup
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
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

/// The first of these that is set is where mpiexec keeps files of its own.
void require_temporary_directory() {
  for (const char* variable : {"TMPDIR", "TEMP", "TMP"}) {
    const char* directory = std::getenv(variable);
    if (!directory) continue;
    if (std::filesystem::is_directory(directory) && access(directory, W_OK | X_OK) == 0) return;
    throw InputError(
        fmt::format("The environment variable {} names {}, which is no directory that can be written to; mpiexec needs one. Make it, or unset {}.",
                    variable, directory, variable));
  }
}

/// The reading end of a pipe, and the end that is passed on.
struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(fmt::format("No pipe can be made: {}.", std::strerror(errno)));
    read = ends[0];
    write = ends[1];
    fcntl(read, F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    ::close(read);
    ::close(write);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  /// What is there now.
  std::string take() const {
    std::string text;
    std::array<char, 1 << 16> block{};
    for (ssize_t got = 0; (got = ::read(read, block.data(), block.size())) > 0 || (got < 0 && errno == EINTR);)
      if (got > 0) text.append(block.data(), static_cast<std::size_t>(got));
    return text;
  }
};

/// What is known of the ranks, from their words.
struct Told {
  bool ready = false;
  std::string results;  ///< directory
  int ended = 0, code = 0;
  std::string rest;  ///< a line that is not whole yet
  void add(const std::string& text) {
    rest += text;
    for (std::size_t end = 0; (end = rest.find('\n')) != std::string::npos; rest.erase(0, end + 1)) {
      const std::string line = rest.substr(0, end), word = line.substr(0, line.find(' ')), object = line.substr(std::min(end, word.size() + 1));
      if (word == "ready") ready = true;
      if (word == "results") results = object;
      if (word != "exit") continue;
      ++ended;
      code = std::max(code, std::atoi(object.c_str()));
    }
  }
};

[[noreturn]] void become_mpiexec(std::vector<std::string> command, const std::string& variable, const Pipe& output, const Pipe& said) {
  setenv(launcher_variable, variable.c_str(), 1);
  // Open MPI refuses to run as root, as one does in containers, unless both are set.
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  // The fast boxes of Open MPI 4.1's shared memory can lose a message, after which the ranks wait in MPI_Allreduce for ever; its queues do not.
  setenv("OMPI_MCA_btl_vader_fbox_max", "0", 0);
  // Open MPI looks for programs, also where it needs none.
  setenv("PATH", "/usr/local/bin:/usr/bin:/bin", 0);
  // A group of its own: Ctrl-C on the terminal reaches the launcher only. It must not outlive it.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (const int nothing = ::open("/dev/null", O_RDONLY); nothing > STDERR_FILENO) dup2(nothing, STDIN_FILENO);
  dup2(output.write, STDOUT_FILENO);
  dup2(said.write, STDERR_FILENO);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::vector<char*> arguments;
  for (std::string& s : command) arguments.push_back(s.data());
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

std::string signal_words(int signal) {
  return fmt::format("signal {} ({}{})", signal, strsignal(signal), signal == SIGKILL ? "; often the machine has no memory left" : "");
}

/// Why the ranks did not end by themselves, as an error message.
std::string sentence(const Told& told, int status, std::string said) {
  while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back()))) said.pop_back();
  const std::string words = said.empty() ? "mpiexec says nothing." : fmt::format("mpiexec says:\n{}", said);
  if (!told.ready) return fmt::format("The ranks could not be started; {}", words);
  std::string text;
  std::smatch match;
  // Open MPI's "process rank 1 with PID 77 on node here exited on signal 9 (Killed)."
  if (std::regex_search(said, match, std::regex(R"(rank (\d+) [^.]*exited on\s+signal (\d+))")))
    text = fmt::format("Rank {} was ended by {}", match[1].str(), signal_words(std::atoi(match[2].str().c_str())));
  else if (WIFSIGNALED(status))
    text = fmt::format("mpiexec was ended by {}", signal_words(WTERMSIG(status)));
  else if (WEXITSTATUS(status) > 128)
    text = fmt::format("A rank was ended by {}", signal_words(WEXITSTATUS(status) - 128));
  else
    return fmt::format("The ranks ended without a result; {}", words);
  return told.results.empty() ? text + "." : fmt::format("{}; the results up to the last finished load step are in {}.", text, told.results);
}

}  // namespace

std::string under_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "MPI_LOCALRANKID"})
    if (std::getenv(name)) return name;
  // srun without PMI sets its own; inside a batch script there is a job, but no step of several tasks.
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  return tasks && std::atoi(tasks) > 1 ? "SLURM_STEP_NUM_TASKS" : "";
}

std::optional<int> launch_ranks(int ranks, int argc, char** argv) {
  if (ranks <= 1 || !under_launcher().empty()) return {};
  const std::string mpiexec = find_program({"mpiexec", "mpirun"});
  require_temporary_directory();
  std::vector<std::string> command{mpiexec};
  if (is_open_mpi(mpiexec)) command.insert(command.end(), {"--oversubscribe", "--bind-to", "none"});
  command.insert(command.end(), {"-n", std::to_string(ranks), std::filesystem::canonical("/proc/self/exe").string()});
  for (int i = 1; i < argc; ++i) command.emplace_back(argv[i]);

  const Pipe words, output, errors, mpiexec_errors;
  const std::string variable = fmt::format("{} {} {} {} {}", getpid(), isatty(STDOUT_FILENO) ? 1 : 0, words.read, output.read, errors.read);
  sigset_t child_signal, before;
  sigemptyset(&child_signal);
  sigaddset(&child_signal, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child_signal, &before);
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw Error(fmt::format("mpiexec cannot be started: {}.", std::strerror(errno)));
  if (child == 0) become_mpiexec(std::move(command), variable, output, mpiexec_errors);
  mpiexec_process = child;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) on_signal(signal, pass_on);
  on_signal(SIGCHLD, wake_up);

  Told told;
  std::string said;
  const auto relay = [&](const Pipe& from, std::FILE* to) {
    const std::string text = from.take();
    std::fwrite(text.data(), 1, text.size(), to);
    std::fflush(to);
  };
  int status = 0;
  for (bool ended = false; !ended;) {
    ended = waitpid(child, &status, WNOHANG) == child;
    if (!ended) {
      std::array<pollfd, 4> wait{{{words.read, POLLIN, 0}, {output.read, POLLIN, 0}, {errors.read, POLLIN, 0}, {mpiexec_errors.read, POLLIN, 0}}};
      ppoll(wait.data(), wait.size(), nullptr, &before);
    }
    told.add(words.take());
    relay(output, stdout);
    relay(errors, stderr);
    said += mpiexec_errors.take();
  }
  sigprocmask(SIG_SETMASK, &before, nullptr);
  if (told.code > 0 || told.ended == ranks) return told.code;
  if (interrupts > 0) return 130;
  fmt::print(stderr, "error: {}\n", printable(sentence(told, status, said)));
  return 3;
}

void join_launcher() {
  const std::optional<Launcher> l = launcher();
  if (!l) return;
  for (const auto& [pipe, standard] : {std::pair(l->output, STDOUT_FILENO), {l->errors, STDERR_FILENO}}) {
    const int descriptor = l->open(pipe);
    if (descriptor < 0) continue;
    dup2(descriptor, standard);
    ::close(descriptor);
  }
}

bool launched() { return launcher().has_value(); }

void report_ready() { tell_launcher("ready"); }

void report_results(const std::string& directory) { tell_launcher("results " + directory); }

int report_exit(int code) { return tell_launcher(fmt::format("exit {}", code)) ? 0 : code; }

bool on_terminal() {
  if (const std::optional<Launcher> l = launcher()) return l->terminal;
  return under_launcher().empty() && isatty(STDOUT_FILENO) != 0;
}

}  // namespace karcher::app
