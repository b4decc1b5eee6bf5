#include "io/page_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "io/binary.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/page.hpp"

namespace karcher {
namespace {

using json = nlohmann::ordered_json;
const std::string too_short = "too short";

void put_floats(BinaryWriter& out, const std::vector<double>& values) { out.numbers<float>(std::vector<float>(values.begin(), values.end())); }

/// What ran: processor, cores, system.
std::string machine_sentence() {
  std::string processor;
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; processor.empty() && std::getline(info, line);)
    if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) processor = line.substr(line.find(": ") + 2);
  utsname system{};
  uname(&system);
  return fmt::format("{}{} cores, {} {}", processor.empty() ? std::string() : processor + ", ", std::max(1U, std::thread::hardware_concurrency()),
                     system.sysname, system.machine);
}

const OutputArray* find(const std::vector<OutputArray>& arrays, const char* name) {
  for (const OutputArray& a : arrays)
    if (a.name == name) return &a;
  return nullptr;
}

bool is_stored(const OutputArray& a) { return a.drawn && a.name != "displacement" && a.name != "reference"; }

json list_of(const std::vector<OutputArray>& arrays) {
  json out = json::array();
  for (const OutputArray& a : arrays)
    if (is_stored(a)) out.push_back({{"name", a.name}, {"components", a.components}});
  return out;
}

std::vector<StoredArray> read_list(const json& list) {
  std::vector<StoredArray> out;
  for (const json& a : list) {
    out.push_back({a.at("name"), a.at("components")});
    if (out.back().components < 1) throw InputError("no components");
  }
  return out;
}

json written_drawing(const Drawing& d) {
  return {{"glyph", static_cast<int>(d.glyph)},
          {"coordinates", d.coordinates},
          {"components", d.components},
          {"place", d.place},
          {"sphere", d.sphere},
          {"directors", d.directors}};
}

Drawing read_drawing(const json& j) {
  const int glyph = j.at("glyph");
  if (glyph < 0 || glyph > static_cast<int>(Glyph::ellipsoid)) throw InputError("unknown glyph");
  return {.glyph = static_cast<Glyph>(glyph),
          .coordinates = j.at("coordinates"),
          .components = j.at("components"),
          .place = j.at("place"),
          .sphere = j.at("sphere"),
          .directors = j.at("directors")};
}

void read_description(const json& j, BinaryReader& reader, Store& store) {
  if (!store.parts.empty() || !store.states.empty()) throw InputError("the states before are of other parts");
  store.machine = j.at("machine");
  store.deformation = j.at("deformation");
  const bool by_name = j.contains("manifolds");  // a description may name the manifold, which has the drawing
  for (const auto& [name, drawing] : j.at(by_name ? "manifolds" : "drawings").items())
    store.drawings[name] = by_name ? manifold_by_name(drawing).drawing : read_drawing(drawing);
  for (const json& term : j.at("terms")) store.terms.push_back(term);
  if (j.contains("loads")) store.loads = j.at("loads");
  if (j.contains("quantities"))
    for (const auto& [name, legend] : j.at("quantities").items()) store.quantities[name] = legend;
  for (const json& p : j.at("parts")) {
    StoredPart part;
    part.region = p.at("region");
    part.dim = p.at("dim");
    part.order = p.at("order");
    if (part.order < 1 || part.order > 3) throw InputError("unknown order");
    part.points = p.at("points");
    part.moves = p.at("moves");
    part.point_data = read_list(p.at("point_data"));
    part.cell_data = read_list(p.at("cell_data"));
    for (const std::uint32_t kind : reader.numbers<std::uint32_t>(p.at("cells"))) {
      if (kind > static_cast<std::uint32_t>(CellKind::hexahedron) || dimension(static_cast<CellKind>(kind)) != part.dim)
        throw InputError("unknown cell");
      part.cells.push_back({static_cast<CellKind>(kind), {}});
    }
    for (OutputCell& c : part.cells)
      for (const std::uint32_t n : reader.numbers<std::uint32_t>(static_cast<std::size_t>(node_count(c.kind, part.order)))) {
        if (n >= part.points) throw InputError("unknown node");
        c.nodes.push_back(static_cast<int>(n));
      }
    part.reference = reader.numbers<float>(part.points, 3);
    for (const StoredArray& a : part.point_data)
      if (const auto found = store.drawings.find(a.name); found != store.drawings.end() && !found->second.complaint(a.components).empty())
        throw InputError("unknown coordinate");
    store.parts.push_back(std::move(part));
  }
}

StoredState read_state(const json& j, BinaryReader& reader, const Store& store) {
  StoredState state;
  state.state = j.at("state");
  state.t = j.at("t");
  for (const auto& [name, value] : j.at("energies").items()) state.energies.emplace_back(name, value.is_null() ? NAN : value.get<double>());
  for (const StoredPart& part : store.parts) {
    StoredValues values;
    if (part.moves) values.displacement = reader.numbers<float>(part.points, 3);
    for (const StoredArray& a : part.point_data)
      values.point_data.push_back(reader.numbers<float>(part.points, static_cast<std::size_t>(a.components)));
    for (const StoredArray& a : part.cell_data)
      values.cell_data.push_back(reader.numbers<float>(part.cells.size(), static_cast<std::size_t>(a.components)));
    state.parts.push_back(std::move(values));
  }
  return state;
}

/// Calls visit(kind, json, rest of the payload, end of the record in the file) for every whole record until it returns false. Returns whether the file ends after the last.
template <class Visit>
bool for_records(std::string_view content, Visit visit) {
  std::size_t at = store_magic.size();
  while (at < content.size()) {
    BinaryReader head(content.substr(at), too_short);
    if (head.left() < 16) return false;
    const auto words = head.numbers<std::uint32_t>(2);
    const auto size = head.number<std::uint64_t>();
    if (size > head.left() || size < 4) return false;
    const std::string_view payload = head.text(size);
    if (check_sum(payload) != words[1]) return false;
    BinaryReader reader(payload, too_short);
    const auto bytes = reader.number<std::uint32_t>();
    if (bytes > reader.left()) return false;
    const std::string_view text = reader.text(bytes);
    at += 16 + size;
    if (!visit(words[0], json::parse(text), reader, at)) break;
  }
  return true;
}

void append_to_file(const std::filesystem::path& file, std::string_view bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const char* what = descriptor < 0 ? std::strerror(errno) : nullptr;
  while (!what && !bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    if (written < 0 && errno != EINTR) what = std::strerror(errno);
  }
  if (descriptor >= 0) ::close(descriptor);
  if (what) throw Error(fmt::format("The file {} cannot be written: {}.", file.string(), what));
}

}  // namespace

std::string record(std::uint32_t kind, const std::string& text, std::string_view numbers) {
  BinaryWriter payload;
  payload.number<std::uint32_t>(static_cast<std::uint32_t>(text.size()));
  payload.text(text);
  payload.text(numbers);
  BinaryWriter out;
  out.number<std::uint32_t>(kind);
  out.number<std::uint32_t>(check_sum(payload.bytes()));
  out.number<std::uint64_t>(payload.bytes().size());
  out.text(payload.bytes());
  return out.bytes();
}

Store read_store(const std::filesystem::path& file) {
  Store store;
  if (!std::filesystem::exists(file)) return store;
  const std::string content = read_whole(file);
  if (std::string_view(content).substr(0, store_magic.size()) != store_magic)
    throw InputError(fmt::format("The file {} does not hold the states of a run of Karcher.", file.string()));
  try {
    store.cut_off = !for_records(content, [&](std::uint32_t kind, const json& j, BinaryReader& reader, std::size_t) {
      if (kind == description_record) read_description(j, reader, store);
      if (kind == state_record) store.states.push_back(read_state(j, reader, store));
      return true;
    });
  } catch (const std::exception&) {  // the check sum is right, so it was written by something else
    throw InputError(fmt::format("The file {} was written by another version of Karcher; run the problem again to see its states.", file.string()));
  }
  return store;
}

const Drawing* draw_as_curves(Store& store) {
  if (!store.deformation.empty() || store.states.empty() || store.parts.size() != 1 || store.parts[0].dim != 1) return nullptr;
  StoredPart& part = store.parts[0];
  for (std::size_t k = 0; k < part.point_data.size(); ++k) {
    const auto found = store.drawings.find(part.point_data[k].name);
    const auto n = static_cast<std::size_t>(part.point_data[k].components);
    if (found == store.drawings.end() || !found->second.place || n < 2 || n > 3) continue;
    part.reference.assign(3 * part.points, 0.0F);
    for (std::size_t i = 0; i < part.points; ++i)
      for (std::size_t c = 0; c < n; ++c) part.reference[3 * i + c] = store.states[0].parts[0].point_data[k][n * i + c];
    for (StoredState& state : store.states) {
      StoredValues& values = state.parts[0];
      values.displacement.assign(3 * part.points, 0.0F);
      for (std::size_t i = 0; i < part.points; ++i)
        for (std::size_t c = 0; c < n; ++c) values.displacement[3 * i + c] = values.point_data[k][n * i + c] - part.reference[3 * i + c];
    }
    part.moves = true;
    return &found->second;
  }
  return nullptr;
}

PageStates::PageStates(std::filesystem::path directory, const OutputModel& model, int first_state) : file_(std::move(directory) / "report.data") {
  json drawings = json::object(), quantities = json::object();
  for (std::size_t f = 0; f < model.fields.size(); ++f) {
    Drawing drawing = model.fields[f].manifold->drawing;
    const bool headless = std::count(model.headless.begin(), model.headless.end(), static_cast<int>(f)) > 0;
    if (headless && drawing.glyph == Glyph::arrow) drawing.glyph = Glyph::rod;
    drawings[model.fields[f].name] = written_drawing(drawing);
  }
  for (std::size_t t = 0; t < model.quantities.size(); ++t)
    for (const QuantityInfo& q : model.quantities[t]) {
      std::string legend = q.description;
      if (q.unit != "1") legend += fmt::format(" ({})", q.unit);
      quantities[quantity_name(q.name, model.terms[t])] = legend;
    }
  const std::string deformation = model.deformation >= 0 ? model.fields[static_cast<std::size_t>(model.deformation)].name : std::string();
  description_ = json{{"machine", machine_sentence()}, {"deformation", deformation}, {"drawings", drawings},
                      {"terms", model.terms},          {"loads", model.loads},       {"quantities", quantities}}
                     .dump();
  std::string kept(store_magic);
  if (first_state > 0 && std::filesystem::exists(file_)) {
    const std::string content = read_whole(file_);
    if (std::string_view(content).substr(0, store_magic.size()) == store_magic) {
      std::size_t end = store_magic.size();
      for_records(content, [&](std::uint32_t kind, const json& j, BinaryReader&, std::size_t record_end) {
        if (kind == state_record && j.at("state").get<int>() >= first_state) return false;
        described_ = described_ || kind == description_record;
        end = record_end;
        return true;
      });
      kept = content.substr(0, end);
    }
  }
  write_atomically(file_, kept);
}

void PageStates::write(int state, double t, const std::vector<OutputPart>& parts, const NamedNumbers& energies) {
  if (!described_) {
    json description = json::parse(description_);
    BinaryWriter numbers;
    json list = json::array();
    for (const OutputPart& p : parts) {
      const OutputArray* reference = find(p.point_data, "reference");
      list.push_back({{"region", p.region},
                      {"dim", p.dim},
                      {"order", p.order},
                      {"points", p.points.size()},
                      {"cells", p.cells.size()},
                      {"moves", find(p.point_data, "displacement") != nullptr},
                      {"point_data", list_of(p.point_data)},
                      {"cell_data", list_of(p.cell_data)}});
      for (const OutputCell& c : p.cells) numbers.number<std::uint32_t>(static_cast<std::uint32_t>(c.kind));
      for (const OutputCell& c : p.cells)
        for (const int n : c.nodes) numbers.number<std::uint32_t>(static_cast<std::uint32_t>(n));
      std::vector<double> places;
      for (const Vec3<double>& x : p.points) places.insert(places.end(), {x[0], x[1], x[2]});
      put_floats(numbers, reference ? reference->values : places);
    }
    description["parts"] = std::move(list);
    append_to_file(file_, record(description_record, description.dump(-1, ' ', false, json::error_handler_t::replace), numbers.bytes()));
    described_ = true;
  }
  BinaryWriter numbers;
  for (const OutputPart& p : parts) {
    if (const OutputArray* displacement = find(p.point_data, "displacement")) put_floats(numbers, displacement->values);
    for (const auto* arrays : {&p.point_data, &p.cell_data})
      for (const OutputArray& a : *arrays)
        if (is_stored(a)) put_floats(numbers, a.values);
  }
  json named = json::object();
  for (const auto& [name, value] : energies) named[name] = value;
  append_to_file(file_,
                 record(state_record, json{{"state", state}, {"t", t}, {"energies", named}}.dump(-1, ' ', false, json::error_handler_t::replace),
                        numbers.bytes()));
}

}  // namespace karcher
