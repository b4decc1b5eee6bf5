#include "app/browser.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <thread>
#include <vector>

#include "karcher/error.hpp"

extern char** environ;

namespace karcher::app {
namespace {

using json = nlohmann::json;

/// A pipe whose ends have numbers of 10 and more, so that they are not in the way of 3 and 4, and are closed in the new program.
std::array<int, 2> make_pipe() {
  int ends[2];
  if (::pipe(ends) != 0) throw Error(fmt::format("A pipe to the browser cannot be made: {}.", std::strerror(errno)));
  std::array<int, 2> out{};
  for (std::size_t i = 0; i < 2; ++i) {
    out[i] = ::fcntl(ends[i], F_DUPFD_CLOEXEC, 10);
    ::close(ends[i]);
  }
  return out;
}

/// Writes to a pipe whose reader may be gone give EPIPE in this scope, not the signal that ends the program.
class IgnorePipeSignal {
 public:
  IgnorePipeSignal() : old_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~IgnorePipeSignal() { std::signal(SIGPIPE, old_); }

 private:
  void (*old_)(int);
};

}  // namespace

std::filesystem::path find_browser() {
  if (const char* named = std::getenv("KARCHER_CHROMIUM"); named && *named) return named;
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"}) {
    std::istringstream folders(path ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::filesystem::path file = std::filesystem::path(folder) / name;
      if (!folder.empty() && ::access(file.c_str(), X_OK) == 0) return file;
    }
  }
  return {};
}

Browser::Browser(const std::filesystem::path& program, std::chrono::seconds patience) : deadline_(std::chrono::steady_clock::now() + patience) {
  std::string profile = (std::filesystem::temp_directory_path() / "karcher-browser-XXXXXX").string();
  if (!::mkdtemp(profile.data())) throw Error(fmt::format("The directory {} cannot be made: {}.", profile, std::strerror(errno)));
  profile_ = profile;
  std::vector<std::string> words{program.string(),         "--headless=new",          "--remote-debugging-pipe",    "--user-data-dir=" + profile,
                                 "--no-first-run",         "--disable-extensions",    "--disable-dev-shm-usage",    "--hide-scrollbars",
                                 "--window-size=1280,800", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"};
  if (::geteuid() == 0) words.emplace_back("--no-sandbox");  // Chromium refuses to run sandboxed as root
  words.emplace_back("about:blank");
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);

  const auto in = make_pipe(), out = make_pipe();  // the browser reads commands from 3 and writes answers to 4
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, in[0], 3);
  posix_spawn_file_actions_adddup2(&files, out[1], 4);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // a group of its own, to be ended with all its children
  const int failure = ::posix_spawn(&process_, program.c_str(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  ::close(in[0]);
  ::close(out[1]);
  to_ = in[1];
  from_ = out[0];
  if (failure != 0) {
    process_ = -1;
    ::close(to_);
    ::close(from_);
    std::error_code ignored;
    std::filesystem::remove_all(profile_, ignored);
    throw Error(fmt::format("The browser {} cannot be started: {}.", program.string(), std::strerror(failure)));
  }
}

Browser::~Browser() {
  ::close(to_);  // the end of its commands ends the browser
  ::close(from_);
  for (int tenths = 0; tenths < 20 && ::waitpid(process_, nullptr, WNOHANG) == 0; ++tenths)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  std::error_code ignored;
  for (int tries = 0; tries < 5 && std::filesystem::exists(profile_, ignored); ++tries) {  // children may write a moment longer
    std::filesystem::remove_all(profile_, ignored);
    if (ignored) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

std::string Browser::read_message() {
  for (;;) {
    if (const std::size_t end = buffer_.find('\0'); end != std::string::npos) {
      std::string message = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      return message;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - std::chrono::steady_clock::now()).count();
    pollfd wait{from_, POLLIN, 0};
    const int ready = left > 0 ? ::poll(&wait, 1, static_cast<int>(left)) : 0;
    if (ready == 0) throw Error("The browser does not answer; the picture was not made.");
    if (ready < 0 && errno == EINTR) continue;
    char block[65536];
    const ssize_t size = ::read(from_, block, sizeof block);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) throw Error("The browser ended before the picture was made.");
    buffer_.append(block, static_cast<std::size_t>(size));
  }
}

json Browser::command(const std::string& method, const json& parameters, const std::string& session) {
  const int id = ++last_id_;
  json message = {{"id", id}, {"method", method}, {"params", parameters}};
  if (!session.empty()) message["sessionId"] = session;
  const std::string text = message.dump() + '\0';
  const IgnorePipeSignal quiet;
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t written = ::write(to_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw Error("The browser ended before the picture was made.");
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  for (;;) {
    json answer = json::parse(read_message());
    if (answer.value("id", 0) == id) return answer;  // the others tell of events
  }
}

std::string Browser::evaluate(const std::string& url, const std::string& expression) {
  const json target = command("Target.createTarget", {{"url", url}});
  if (!target.contains("result")) throw Error("The browser cannot open the page.");
  const json attached = command("Target.attachToTarget", {{"targetId", target["result"]["targetId"]}, {"flatten", true}});
  if (!attached.contains("result")) throw Error("The browser cannot open the page.");
  const std::string session = attached["result"]["sessionId"];
  for (;;) {
    const json answer = command("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}}, session);
    if (answer.contains("error")) {  // the empty first document gave way to the page
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    const json& result = answer.at("result");
    if (result.contains("exceptionDetails")) {
      const json& thrown = result["exceptionDetails"].value("exception", json::object());
      std::string words = thrown.value("description", thrown.value("value", std::string("The page refuses.")));
      words = words.substr(0, words.find("\n    at "));  // the sentence, without the places in the script
      if (words.rfind("Error: ", 0) == 0) words.erase(0, 7);
      throw InputError(words);
    }
    return result.at("result").value("value", std::string());
  }
}

std::string percent_encoded(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || std::strchr("-._~/", c);
    if (plain && c != '\0')
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string file_url(const std::filesystem::path& path) { return "file://" + percent_encoded(std::filesystem::absolute(path).string()); }

}  // namespace karcher::app
