#include "karcher/io/checkpoint.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"

namespace karcher {
namespace {

// File, little-endian: magic (8 bytes), version (u32), CRC-32 of the rest (u32), length of the rest (u64), then the rest:
// identity (u64), load step (i64), t, increment (f64), summary (string), number of fields (u64), for each field: name, manifold (strings), ambient (u64),
// number of values (u64), values (f64). A string is its length (u64) and its bytes.
constexpr std::string_view magic = "KARCHER\x1a";
constexpr std::uint32_t version = 1;
constexpr std::size_t head_size = 24;
static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(std::string_view s) {
    put(static_cast<std::uint64_t>(s.size()));
    text_.append(s);
  }
  void put(const std::vector<double>& v) {
    put(static_cast<std::uint64_t>(v.size()));
    text_.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(double));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads a payload whose check sum is right; lengths are checked nonetheless, so that no file whatever makes us read beyond its end.
class Reader {
 public:
  Reader(std::string_view rest, std::string source) : rest_(rest), source_(std::move(source)) {}
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string get_string() { return std::string(take(get<std::uint64_t>())); }
  std::vector<double> get_doubles() {
    const auto n = get<std::uint64_t>();
    if (n > rest_.size() / sizeof(double)) throw damaged();
    std::vector<double> v(n);
    const std::string_view bytes = take(n * sizeof(double));
    if (n > 0) std::memcpy(v.data(), bytes.data(), bytes.size());
    return v;
  }
  bool empty() const { return rest_.empty(); }
  InputError damaged() const { return InputError(fmt::format("The checkpoint {} is damaged.", source_)); }

 private:
  std::string_view take(std::uint64_t n) {
    if (n > rest_.size()) throw damaged();
    const std::string_view piece = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return piece;
  }
  std::string_view rest_;
  std::string source_;
};

std::uint32_t check_sum(std::string_view text) {
  uLong crc = crc32(0, nullptr, 0);
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(text.data()), text.size());
  return static_cast<std::uint32_t>(crc);
}

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
    for (const Cell& c : mesh->cells) {
      add(static_cast<long>(c.kind)).add(static_cast<long>(c.order));
      for (const int n : c.nodes) add(static_cast<long>(n));
    }
  }
  return *this;
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, std::span<const Field> fields, std::uint64_t identity) {
  Writer body;
  body.put(identity);
  body.put(static_cast<std::int64_t>(checkpoint.load_step));
  body.put(checkpoint.configuration.t);
  body.put(checkpoint.increment);
  body.put(std::string_view(checkpoint.summary));
  body.put(static_cast<std::uint64_t>(fields.size()));
  for (std::size_t i = 0; i < fields.size(); ++i) {
    body.put(std::string_view(fields[i].name));
    body.put(std::string_view(fields[i].manifold->name));
    body.put(static_cast<std::uint64_t>(fields[i].manifold->ambient));
    body.put(checkpoint.configuration.values[i]);
  }
  std::string content(magic);
  Writer head;
  head.put(version);
  head.put(check_sum(body.text()));
  head.put(static_cast<std::uint64_t>(body.text().size()));
  write_atomically(file, content + head.text() + body.text());
}

Checkpoint read_checkpoint(const std::filesystem::path& file, std::span<const Field> fields, std::uint64_t identity) {
  const std::string content = read_whole(file);
  const std::string source = file.string();
  if (content.size() < magic.size() ? !magic.starts_with(content) || content.empty() : !content.starts_with(magic))
    throw InputError(fmt::format("{} is not a checkpoint of Karcher.", source));
  const auto truncated = [&] { return InputError(fmt::format("The checkpoint {} is truncated.", source)); };
  if (content.size() < head_size) throw truncated();
  Reader head(std::string_view(content).substr(magic.size(), head_size - magic.size()), source);
  if (const auto v = head.get<std::uint32_t>(); v != version)
    throw InputError(fmt::format("The checkpoint {} has version {}; this program reads version {}.", source, v, version));
  const auto sum = head.get<std::uint32_t>();
  const auto length = head.get<std::uint64_t>();
  const std::string_view text = std::string_view(content).substr(head_size);
  if (text.size() < length) throw truncated();
  if (text.size() > length || check_sum(text) != sum) throw head.damaged();

  Reader body(text, source);
  const auto stored_identity = body.get<std::uint64_t>();
  Checkpoint c;
  c.load_step = static_cast<int>(body.get<std::int64_t>());
  c.configuration.t = body.get<double>();
  c.increment = body.get<double>();
  c.summary = body.get_string();
  const auto foreign = [&](const std::string& holds, const std::string& needs) {
    return InputError(fmt::format("The checkpoint {} belongs to another problem: it holds {}, the problem has {}.", source, holds, needs));
  };
  const auto count = body.get<std::uint64_t>();
  if (count != fields.size()) throw foreign(fmt::format("{} fields", count), fmt::format("{}", fields.size()));
  for (const Field& f : fields) {
    const std::string field = body.get_string(), manifold = body.get_string();
    const auto ambient = body.get<std::uint64_t>();
    c.configuration.values.push_back(body.get_doubles());
    const std::size_t nodes = ambient > 0 ? c.configuration.values.back().size() / ambient : 0;
    const auto expected = static_cast<std::size_t>(f.space->node_count());
    if (field != f.name || manifold != f.manifold->name || ambient != static_cast<std::uint64_t>(f.manifold->ambient) || nodes != expected ||
        c.configuration.values.back().size() != nodes * ambient)
      throw foreign(fmt::format("field {} in {} with {} nodes", field, manifold, nodes),
                    fmt::format("field {} in {} with {} nodes", f.name, f.manifold->name, expected));
  }
  if (!body.empty()) throw body.damaged();
  if (stored_identity != identity)
    throw InputError(fmt::format(
        "The checkpoint {} belongs to another problem: mesh, energies, loads or boundary data have changed since it was written.", source));
  return c;
}

}  // namespace karcher
