#pragma once
/// \file
/// Runs the built program as a user does, in a directory of its own.

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include "temporary_directory.hpp"

namespace karcher::testing {

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A directory that disappears with it.
class Workshop {
 public:
  const std::filesystem::path& directory() const { return directory_.path(); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return directory_ / name;
  }
  /// "karcher ARGUMENTS", run in the directory. \param before shell words before it
  Outcome karcher(const std::string& arguments, const std::string& before = "") const {
    return outcome(std::system(command(before, arguments).c_str()));
  }
  /// Starts "karcher ARGUMENTS", calls act(its process) as soon as `ready`, or it has ended, and waits for it.
  template <class Ready, class Act>
  Outcome meanwhile(const std::string& arguments, Ready ready, Act act) const {
    const pid_t child = fork();
    if (child == 0) {
      execl("/bin/sh", "sh", "-c", command("exec", arguments).c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    int status = 0;
    bool ended = false;
    while (!ended && !ready()) {
      ended = waitpid(child, &status, WNOHANG) == child;
      usleep(10000);
    }
    if (!ended) {
      act(child);
      waitpid(child, &status, 0);
    }
    return outcome(status);
  }
  /// The exit code of "karcher ARGUMENTS" that gets SIGINT as soon as `ready`.
  template <class Ready>
  int interrupted(const std::string& arguments, Ready ready) const {
    return meanwhile(arguments, ready, [](pid_t process) { kill(process, SIGINT); }).code;
  }
  /// Names of everything in the directory.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(directory())) names.insert(e.path().lexically_relative(directory()).string());
    return names;
  }

 private:
  std::string command(const std::string& before, const std::string& arguments) const {
    return "cd '" + directory().string() + "' && " + before + " '" + std::string(KARCHER_BINARY_DIR) + "/karcher' " + arguments +
           " >.stdout 2>.stderr </dev/null";
  }
  /// Of a process that has ended with a status of waitpid.
  Outcome outcome(int status) const {
    Outcome o;
    o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    o.out = content(directory_ / ".stdout");
    o.err = content(directory_ / ".stderr");
    std::filesystem::remove(directory_ / ".stdout");
    std::filesystem::remove(directory_ / ".stderr");
    return o;
  }

  TemporaryDirectory directory_;
};

}  // namespace karcher::testing
