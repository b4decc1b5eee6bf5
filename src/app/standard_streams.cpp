#include "app/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace karcher::app {
namespace {

struct Stream {
  int descriptor;
  int error = 0;  ///< errno of the first failure
};
Stream output{STDOUT_FILENO}, errors{STDERR_FILENO};

ssize_t write_all(void* cookie, const char* data, std::size_t size) {
  Stream& stream = *static_cast<Stream*>(cookie);
  for (std::size_t done = 0; stream.error == 0 && done < size;) {
    const ssize_t written = ::write(stream.descriptor, data + done, size - done);
    if (written >= 0)
      done += static_cast<std::size_t>(written);
    else if (errno != EINTR)
      stream.error = errno;
  }
  return static_cast<ssize_t>(size);
}

/// In the GNU C library the standard streams are variables that a program may set.
void guard(std::FILE*& file, Stream& stream, int buffering) {
  cookie_io_functions_t functions{};
  functions.write = write_all;
  std::FILE* guarded = fopencookie(&stream, "w", functions);
  if (!guarded) return;
  std::setvbuf(guarded, nullptr, buffering, BUFSIZ);
  file = guarded;
}

}  // namespace

void guard_standard_streams() {
  // Closed ones are open for reading only, so that writing to them fails as before. The lowest free descriptor is the one that is given.
  for (int descriptor = 0; descriptor <= STDERR_FILENO;) {
    descriptor = ::open("/dev/null", O_RDONLY);
    if (descriptor < 0) break;
    if (descriptor > STDERR_FILENO) ::close(descriptor);
  }
  std::signal(SIGPIPE, SIG_IGN);
  guard(stdout, output, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF);
  guard(stderr, errors, _IONBF);
}

std::string output_failure() {
  std::fflush(stdout);
  return output.error == 0 ? "" : std::strerror(output.error);
}

}  // namespace karcher::app
