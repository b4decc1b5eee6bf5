#include "karcher/io/checkpoint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io/binary.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"

namespace karcher {
namespace {

// File, little-endian: magic (8 bytes), version (u32), CRC-32 of the rest (u32), length of the rest (u64), then the rest:
// identity (u64), load step (i64), t, increment, largest gradient (f64), summary (string), number of fields (u64), for each field: name, manifold (strings), ambient (u64),
// number of values (u64), values (f64). A string is its length (u64) and its bytes.
constexpr std::string_view magic = "KARCHER\x1a";
constexpr std::uint32_t version = 3;
constexpr std::size_t head_size = 24;

/// A length (u64) and as many bytes or numbers.
void put(BinaryWriter& writer, std::string_view text) {
  writer.number<std::uint64_t>(text.size());
  writer.text(text);
}
void put(BinaryWriter& writer, const std::vector<double>& values) {
  writer.number<std::uint64_t>(values.size());
  writer.numbers<double>(values);
}
std::string get_text(BinaryReader& reader) { return std::string(reader.text(reader.number<std::uint64_t>())); }
std::vector<double> get_numbers(BinaryReader& reader) { return reader.numbers<double>(reader.number<std::uint64_t>()); }

}  // namespace

void Identity::bytes(const void* data, std::size_t size) {
  const auto* b = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) hash_ = (hash_ ^ b[i]) * 1099511628211ULL;
}

Identity& Identity::add(std::string_view text) {
  add(static_cast<long>(text.size()));  // so that "ab", "c" differs from "a", "bc"
  bytes(text.data(), text.size());
  return *this;
}

Identity& Identity::add(double number) {
  const double positive_zero = number + 0.0;  // -0 and 0 are the same data
  bytes(&positive_zero, sizeof positive_zero);
  return *this;
}

Identity& Identity::add(long number) {
  const std::int64_t n = number;
  bytes(&n, sizeof n);
  return *this;
}

Identity& Identity::add(std::span<const Field> fields) {
  const Mesh* mesh = nullptr;
  add(static_cast<long>(fields.size()));
  for (const Field& f : fields) {
    add(std::string_view(f.name)).add(std::string_view(f.manifold->name)).add(static_cast<long>(f.rule)).add(static_cast<long>(f.space->order()));
    add(std::string_view(f.space->region().name))
        .add(static_cast<long>(f.space->node_count()))
        .add(static_cast<long>(f.space->region().cells.size()));
    if (&f.space->mesh() == mesh) continue;
    mesh = &f.space->mesh();
    add(static_cast<long>(mesh->nodes.size()));
    for (const auto& x : mesh->nodes)
      for (int i = 0; i < 3; ++i) add(x[i]);
    const auto add_cells = [&](const std::vector<Cell>& cells) {
      for (const Cell& c : cells) {
        add(static_cast<long>(c.kind)).add(static_cast<long>(c.order));
        for (const int n : c.nodes) add(static_cast<long>(n));
      }
    };
    add_cells(mesh->cells);
    for (const auto& [name, region] : mesh->regions) {
      add(std::string_view(name)).add(static_cast<long>(region.cells.size()));
      add_cells(region.cells);
    }
  }
  return *this;
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, std::span<const Field> fields, std::uint64_t identity) {
  BinaryWriter body;
  body.number<std::uint64_t>(identity);
  body.number<std::int64_t>(checkpoint.load_step);
  body.number<double>(checkpoint.configuration.t);
  body.number<double>(checkpoint.increment);
  body.number<double>(checkpoint.largest_gradient);
  put(body, checkpoint.summary);
  body.number<std::uint64_t>(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    put(body, fields[i].name);
    put(body, fields[i].manifold->name);
    body.number<std::uint64_t>(static_cast<std::uint64_t>(fields[i].manifold->ambient));
    put(body, checkpoint.configuration.values[i]);
  }
  BinaryWriter file_content;
  file_content.text(magic);
  file_content.number<std::uint32_t>(version);
  file_content.number<std::uint32_t>(check_sum(body.bytes()));
  put(file_content, body.bytes());
  write_atomically(file, file_content.bytes());
}

Checkpoint read_checkpoint(const std::filesystem::path& file, std::span<const Field> fields, std::uint64_t identity) {
  const std::string content = read_whole(file);
  const std::string source = file.string();
  if (content.size() < magic.size() ? !magic.starts_with(content) || content.empty() : !content.starts_with(magic))
    throw InputError(fmt::format("{} is not a checkpoint of Karcher.", source));
  const auto truncated = [&] { return InputError(fmt::format("The checkpoint {} is truncated.", source)); };
  if (content.size() < head_size) throw truncated();
  const std::string damaged = fmt::format("The checkpoint {} is damaged.", source);
  BinaryReader head(std::string_view(content).substr(magic.size(), head_size - magic.size()), damaged);
  if (const auto v = head.number<std::uint32_t>(); v != version)
    throw InputError(fmt::format("The checkpoint {} has version {}; this program reads version {}.", source, v, version));
  const auto sum = head.number<std::uint32_t>();
  const auto length = head.number<std::uint64_t>();
  const std::string_view text = std::string_view(content).substr(head_size);
  if (text.size() < length) throw truncated();
  if (text.size() > length || check_sum(text) != sum) throw InputError(damaged);

  BinaryReader body(text, damaged);
  const auto stored_identity = body.number<std::uint64_t>();
  Checkpoint c;
  const auto load_step = body.number<std::int64_t>();
  c.load_step = static_cast<int>(load_step);
  c.configuration.t = body.number<double>();
  c.increment = body.number<double>();
  c.largest_gradient = body.number<double>();
  const bool possible = load_step >= 0 && load_step < std::numeric_limits<int>::max() && std::isfinite(c.configuration.t) &&
                        std::isfinite(c.increment) && std::isfinite(c.largest_gradient) && c.largest_gradient >= 0;
  if (!possible) throw InputError(damaged);
  c.summary = get_text(body);
  const auto foreign = [&](const std::string& holds, const std::string& needs) {
    return InputError(fmt::format("The checkpoint {} belongs to another problem: it holds {}, the problem has {}.", source, holds, needs));
  };
  const auto count = body.number<std::uint64_t>();
  if (count != fields.size()) throw foreign(fmt::format("{} fields", count), fmt::format("{}", fields.size()));
  for (const Field& f : fields) {
    const std::string field = get_text(body), manifold = get_text(body);
    const auto ambient = body.number<std::uint64_t>();
    c.configuration.values.push_back(get_numbers(body));
    const std::size_t nodes = ambient > 0 ? c.configuration.values.back().size() / ambient : 0;
    const auto expected = static_cast<std::size_t>(f.space->node_count());
    if (field != f.name || manifold != f.manifold->name || ambient != static_cast<std::uint64_t>(f.manifold->ambient) || nodes != expected ||
        c.configuration.values.back().size() != nodes * ambient)
      throw foreign(fmt::format("field {} in {} with {} nodes", field, manifold, nodes),
                    fmt::format("field {} in {} with {} nodes", f.name, f.manifold->name, expected));
  }
  if (body.left() > 0) throw InputError(damaged);
  if (stored_identity != identity)
    throw InputError(fmt::format(
        "The checkpoint {} belongs to another problem: mesh, energies, loads or boundary data have changed since it was written.", source));
  return c;
}

}  // namespace karcher
