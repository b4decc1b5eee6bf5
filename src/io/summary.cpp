#include "karcher/io/summary.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"

namespace karcher {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order of the contract, for human readers

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

double number(const Json& j) { return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>(); }

Json numbers(const NamedNumbers& values) {
  Json j = Json::object();
  for (const auto& [key, value] : values) j[key] = number(value);
  return j;
}

NamedNumbers numbers(const Json& j) {
  NamedNumbers values;
  for (const auto& [key, value] : j.items()) values.emplace_back(key, number(value));
  return values;
}

Json work(const WorkCounts& w) {
  return {{"factorisations", w.factorisations}, {"hessians", w.hessians}, {"gradients", w.gradients}, {"energies", w.energies}, {"solves", w.solves}};
}

WorkCounts work(const Json& j) {
  WorkCounts w;
  w.factorisations = j.at("factorisations");
  w.hessians = j.at("hessians");
  w.gradients = j.at("gradients");
  w.energies = j.at("energies");
  w.solves = j.at("solves");
  return w;
}

Status status(const Json& j) {
  const auto text = j.get<std::string>();
  for (const Status s : {Status::converged, Status::not_converged, Status::interrupted, Status::failed})
    if (text == name(s)) return s;
  throw InputError(fmt::format("unknown status \"{}\"", text));
}

Json load_step(const LoadStepSummary& s) {
  Json probes = Json::object();
  for (const auto& [key, values] : s.probes) {
    Json list = Json::array();
    for (const double x : values) list.push_back(number(x));
    probes[key] = std::move(list);
  }
  Json strain = nullptr, charges = Json::object();
  if (const auto& largest = s.largest_strain)
    strain = {{"energy", largest->energy}, {"value", number(largest->value)}, {"place", {largest->place[0], largest->place[1], largest->place[2]}}};
  for (const auto& [field, charge] : s.topological_charge) charges[field] = number(charge);
  return {{"t", number(s.t)},
          {"status", name(s.status)},
          {"iterations", s.iterations},
          {"energy", number(s.energy)},
          {"gradient_norm", number(s.gradient_norm)},
          {"negative_eigenvalues", s.negative_eigenvalues >= 0 ? Json(s.negative_eigenvalues) : Json(nullptr)},
          {"neutral_eigenvalues", s.neutral_eigenvalues},
          {"probes", std::move(probes)},
          {"seconds", number(s.seconds)},
          {"reason", s.reason},
          {"warnings", s.warnings},
          {"largest_strain", std::move(strain)},
          {"topological_charge", std::move(charges)},
          {"work", work(s.work)}};
}

LoadStepSummary load_step(const Json& j) {
  LoadStepSummary s;
  s.t = number(j.at("t"));
  s.status = status(j.at("status"));
  s.iterations = j.at("iterations");
  s.energy = number(j.at("energy"));
  s.gradient_norm = number(j.at("gradient_norm"));
  const Json& negative = j.at("negative_eigenvalues");
  s.negative_eigenvalues = negative.is_null() ? -1 : negative.get<int>();
  s.neutral_eigenvalues = j.at("neutral_eigenvalues");
  for (const auto& [key, list] : j.at("probes").items())
    for (const Json& x : list) s.probes[key].push_back(number(x));
  s.seconds = number(j.at("seconds"));
  s.reason = j.at("reason");
  s.warnings = j.at("warnings").get<std::vector<std::string>>();
  if (const Json& strain = j.at("largest_strain"); !strain.is_null()) {
    const Json& place = strain.at("place");
    s.largest_strain = {strain.at("energy"), number(strain.at("value")), {{place.at(0), place.at(1), place.at(2)}}};
  }
  for (const auto& [field, charge] : j.at("topological_charge").items()) s.topological_charge[field] = number(charge);
  s.work = work(j.at("work"));
  return s;
}

/// What read() makes of a text. \throws InputError with the trouble where the text is something else
template <class Read>
auto read_as(const std::string& trouble, const Read& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{}: {}.", trouble, e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}.", trouble, e.what()));
  }
}

}  // namespace

LoadStepSummary summarize(const StepReport& report) {
  LoadStepSummary s;
  s.t = report.t;
  s.status = report.status;
  s.iterations = report.iterations;
  s.energy = report.energy;
  s.gradient_norm = report.gradient_norm;
  s.negative_eigenvalues = report.negative_eigenvalues;
  s.neutral_eigenvalues = report.neutral_eigenvalues;
  s.seconds = report.seconds;
  s.reason = report.reason;
  s.warnings = report.warnings;
  s.work = report.work;
  return s;
}

std::vector<std::string> distinct_names(std::vector<std::string> names) {
  std::set<std::string> taken;
  std::map<std::string, int> last;  // numbers up to it are taken
  for (std::string& n : names) {
    std::string candidate = n;
    for (int& k = last.try_emplace(n, 1).first->second; !taken.insert(candidate).second;) candidate = fmt::format("{}-{}", n, ++k);
    n = candidate;
  }
  return names;
}

std::string to_json(const Summary& s) {
  Json parts = Json::object(), steps = Json::array(), errors = Json::object();
  for (const auto& [term, values] : s.parts) parts[term] = numbers(values);
  for (const LoadStepSummary& step : s.load_steps) steps.push_back(load_step(step));
  for (const auto& [field, e] : s.errors) errors[field] = {{"l2", number(e.l2)}, {"h1", number(e.h1)}};
  const Json j = {{"title", s.title},
                  {"version", s.version},
                  {"status", name(s.status)},
                  {"reason", s.reason},
                  {"warnings", s.warnings},
                  {"mesh", {{"cells", s.mesh.cells}, {"nodes", s.mesh.nodes}, {"order", s.mesh.order}}},
                  {"unknowns", s.unknowns},
                  {"free_unknowns", s.free_unknowns},
                  {"ranks", s.ranks},
                  {"energy", number(s.energy)},
                  {"energies", numbers(s.energies)},
                  {"parts", std::move(parts)},
                  {"load_steps", std::move(steps)},
                  {"errors", std::move(errors)},
                  {"work", work(s.work)},
                  {"seconds",
                   {{"total", number(s.seconds.total)},
                    {"assembly", number(s.seconds.assembly)},
                    {"factorisation", number(s.seconds.factorisation)},
                    {"solve", number(s.seconds.solve)},
                    {"output", number(s.seconds.output)},
                    {"setup", number(s.seconds.setup)}}},
                  {"peak_memory_mb", number(s.peak_memory_mb)}};
  // A title may hold bytes that are no UTF-8; a summary is more use with a replacement character than not at all.
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_json_line(const LoadStepSummary& step) { return load_step(step).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

LoadStepSummary load_step_from_json(std::string_view text, const std::string& source) {
  return read_as(fmt::format("{} is not a load step of a run", source), [&] { return load_step(Json::parse(text)); });
}

Summary summary_from_json(const std::string& text, const std::string& source) {
  return read_as(fmt::format("{} is not a summary of a run", source), [&] {
    const Json j = Json::parse(text);
    Summary s;
    s.title = j.at("title");
    s.version = j.at("version");
    s.status = status(j.at("status"));
    s.reason = j.at("reason");
    s.warnings = j.at("warnings").get<std::vector<std::string>>();
    const Json& mesh = j.at("mesh");
    s.mesh.cells = mesh.at("cells");
    s.mesh.nodes = mesh.at("nodes");
    s.mesh.order = mesh.at("order");
    s.unknowns = j.at("unknowns");
    s.free_unknowns = j.at("free_unknowns");
    s.ranks = j.at("ranks");
    s.energy = number(j.at("energy"));
    s.energies = numbers(j.at("energies"));
    for (const auto& [term, values] : j.at("parts").items()) s.parts[term] = numbers(values);
    for (const Json& step : j.at("load_steps")) s.load_steps.push_back(load_step(step));
    for (const auto& [field, e] : j.at("errors").items()) s.errors[field] = {number(e.at("l2")), number(e.at("h1"))};
    s.work = work(j.at("work"));
    const Json& seconds = j.at("seconds");
    s.seconds = {number(seconds.at("total")), number(seconds.at("assembly")), number(seconds.at("factorisation")),
                 number(seconds.at("solve")), number(seconds.at("output")),   number(seconds.at("setup"))};
    s.peak_memory_mb = number(j.at("peak_memory_mb"));
    return s;
  });
}

void write_summary(const std::filesystem::path& file, const Summary& summary) { write_atomically(file, to_json(summary)); }

Summary read_summary(const std::filesystem::path& file) { return summary_from_json(read_whole(file), file.string()); }

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;  // Linux counts in units of 1024 bytes
}

}  // namespace karcher
