#pragma once
/// \file
/// Checkpoint: everything needed to continue a run after its last finished load step, on one rank to the last bit.
///
/// The file has a magic word, a version, the identity of the problem, the values of all fields as IEEE doubles and a check sum; it is written atomically.
/// A file that is foreign, truncated, damaged, of another version or of another problem is refused by a sentence that says which.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "karcher/field/field.hpp"

namespace karcher {

struct Checkpoint {
  int load_step = 0;            ///< load steps finished
  double increment = 0;         ///< StepReport::next_increment of the last of them
  double largest_gradient = 0;  ///< its StepReport::largest_gradient
  Configuration configuration;
  std::string summary;  ///< JSON of the run so far (to_json), without its load steps: they are in load_steps.jsonl
};

/// Hash (64-bit FNV-1a) of what makes two problems the same for a checkpoint.
class Identity {
 public:
  Identity& add(std::string_view text);
  Identity& add(double number);
  Identity& add(long number);
  /// Names, manifolds, rules, orders, regions and meshes (nodes, cells and the cells of all regions) of the fields.
  Identity& add(std::span<const Field> fields);
  std::uint64_t value() const { return hash_; }

 private:
  void bytes(const void* data, std::size_t size);
  std::uint64_t hash_ = 14695981039346656037ULL;
};

/// \param identity of fields and of whatever else must not change between the runs (energies, loads, boundary data)
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, std::span<const Field> fields, std::uint64_t identity);

/// \throws InputError if the file is missing, foreign, truncated, damaged, of another version, or of another problem (fields named one by one, then identity).
Checkpoint read_checkpoint(const std::filesystem::path& file, std::span<const Field> fields, std::uint64_t identity);

}  // namespace karcher
