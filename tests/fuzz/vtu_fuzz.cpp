// Files of states that a field may start from.

#include "fuzz/fuzzing.hpp"
#include "karcher/io/vtu.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace karcher;
  static fuzzing::MemoryFile file;
  const std::string content(fuzzing::text_of(data, size));
  fuzzing::take_or_refuse([&] { read_vtu(file.holding(content)); });
  return 0;
}
