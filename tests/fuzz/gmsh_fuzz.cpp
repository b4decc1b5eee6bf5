// Mesh files of one of the four formats (KARCHER_FUZZ_FORMAT, the text of its $MeshFormat). An input that does not begin with that section gets it put in front,
// so that what is tried is what stands behind it.

#include <cstring>

#include "fuzz/fuzzing.hpp"
#include "karcher/mesh/gmsh.hpp"
#include "karcher/mesh/seams.hpp"

namespace {

std::string format_section() {
  const std::string format = KARCHER_FUZZ_FORMAT;
  std::string section = "$MeshFormat\n" + format + "\n";
  if (format == "2.2 1 8" || format == "4.1 1 8") section += std::string("\1\0\0\0\n", 5);
  return section + "$EndMeshFormat\n";
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string format = format_section();
  static karcher::fuzzing::MemoryFile file;
  const std::string_view text = karcher::fuzzing::text_of(data, size);
  const std::string& path = file.holding(text.starts_with("$MeshFormat") ? std::string(text) : format + std::string(text));
  karcher::fuzzing::take_or_refuse([&] { karcher::seams(karcher::read_gmsh(path)); });
  return 0;
}
