// Checkpoints, for a problem with two fields on one quadrilateral, as they are and with the length and the check sum that their head should tell: no
// chance finds those.

#include <cstring>
#include <memory>
#include <vector>

#include "fuzz/fuzzing.hpp"
#include "io/binary.hpp"
#include "io/fields.hpp"
#include "karcher/io/checkpoint.hpp"
#include "karcher/io/summary.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace karcher;
  static const auto mesh = testing::generated("rectangle", {{"cells", {1, 1}}}, {{"shape", "quadrilateral"}});
  static const std::vector<Field> fields{testing::field_on(mesh, mesh->regions.at("all"), "m", "R3", 1),
                                         testing::field_on(mesh, mesh->regions.at("all"), "Q", "SO3", 1)};
  static fuzzing::MemoryFile file;
  constexpr std::size_t sum_at = 12, length_at = 16, head = 24;
  std::string content(fuzzing::text_of(data, size));
  const auto read = [&] {
    fuzzing::take_or_refuse([&] {
      const Checkpoint checkpoint = read_checkpoint(file.holding(content), fields, 5);
      summary_from_json(checkpoint.summary, "checkpoint");
    });
  };
  read();
  if (size < head) return 0;
  const std::string_view body = std::string_view(content).substr(head);
  const std::uint32_t sum = check_sum(body);
  const std::uint64_t length = body.size();
  std::memcpy(content.data() + sum_at, &sum, sizeof sum);
  std::memcpy(content.data() + length_at, &length, sizeof length);
  read();
  return 0;
}
