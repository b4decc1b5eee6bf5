#pragma once
/// \file
/// What the fuzzers share. Each is a reader and LLVMFuzzerTestOneInput; libFuzzer (https://llvm.org/docs/LibFuzzer.html) calls it with one input after another and
/// keeps those that reach something new.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "karcher/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace karcher::fuzzing {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) { return {reinterpret_cast<const char*>(data), size}; }

/// A reader takes its input, or says by an InputError what is wrong with it. Whatever else it throws ends the fuzzer, as memory faults, undefined behaviour,
/// allocations and times beyond the limits of scripts/fuzz.sh do.
template <class Read>
void take_or_refuse(Read read) {
  try {
    read();
  } catch (const InputError& refusal) {
    if (std::string_view(refusal.what()).empty()) throw std::logic_error("a refusal without a sentence");
  }
}

/// A file in memory, for readers that take a path.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("input", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(descriptor_)) {}
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const std::string& holding(std::string_view content) {
    if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, content.data(), content.size(), 0) != static_cast<ssize_t>(content.size()))
      throw std::runtime_error("the file in memory cannot be written");
    return path_;
  }

 private:
  int descriptor_;
  std::string path_;
};

}  // namespace karcher::fuzzing
