// report.data, read and made into the shape of a page, as it is and with the check sums that its records should have: no chance finds those.

#include <cstring>
#include <numeric>

#include "fuzz/fuzzing.hpp"
#include "io/binary.hpp"
#include "io/page_fields.hpp"
#include "io/page_geometry.hpp"
#include "io/page_store.hpp"

namespace {

/// The file with right check sums in all whole records.
std::string mended(std::string content) {
  constexpr std::size_t sum_at = 4, length_at = 8, head = 16;
  std::size_t at = karcher::store_magic.size();
  while (content.size() >= at + head) {
    std::uint64_t length = 0;
    std::memcpy(&length, content.data() + at + length_at, sizeof length);
    if (length > content.size() - at - head) break;
    const std::uint32_t sum = karcher::check_sum(std::string_view(content).substr(at + head, length));
    std::memcpy(content.data() + at + sum_at, &sum, sizeof sum);
    at += head + length;
  }
  return content;
}

void draw(karcher::Store store) {
  if (store.states.empty()) return;
  karcher::draw_as_curves(store);
  std::vector<int> states(std::min<std::size_t>(store.states.size(), 3));
  std::iota(states.begin(), states.end(), 0);
  const karcher::PageGeometry shape = karcher::page_geometry(store, states, 200);
  karcher::PageArrays arrays;
  if (!shape.vertices.empty()) karcher::shape_header(store, states, shape, 20, arrays);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static karcher::fuzzing::MemoryFile file;
  const std::string content(karcher::fuzzing::text_of(data, size));
  for (const std::string& bytes : {content, mended(content)})
    karcher::fuzzing::take_or_refuse([&] { draw(karcher::read_store(file.holding(bytes))); });
  return 0;
}
