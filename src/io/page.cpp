#include "karcher/io/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/page_data.hpp"
#include "io/page_fields.hpp"
#include "io/page_geometry.hpp"
#include "io/page_store.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/iterations.hpp"
#include "karcher/io/load_steps_file.hpp"

namespace karcher {
namespace {

using json = nlohmann::ordered_json;

/// A number, or null where JSON has none.
json number(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

json load_steps(const Summary& summary, const Store& store) {
  json out = json::array();
  std::map<int, const StoredState*> stored;
  for (const StoredState& state : store.states) stored[state.state] = &state;
  int k = 0;
  for (const LoadStepSummary& s : summary.load_steps) {
    ++k;
    json energies = json::object(), probes = json::object();
    if (const auto state = stored.find(k); state != stored.end())
      for (const auto& [name, value] : state->second->energies) energies[name] = number(value);
    if (energies.empty() && k == static_cast<int>(summary.load_steps.size()))
      for (const auto& [name, value] : summary.energies) energies[name] = number(value);
    for (const auto& [name, values] : s.probes) {
      probes[name] = json::array();
      for (const double v : values) probes[name].push_back(number(v));
    }
    out.push_back({{"step", k},
                   {"t", number(s.t)},
                   {"status", name(s.status)},
                   {"reason", s.reason},
                   {"iterations", s.iterations},
                   {"energy", number(s.energy)},
                   {"energies", std::move(energies)},
                   {"probes", std::move(probes)},
                   {"gradient_norm", number(s.gradient_norm)},
                   {"negative_eigenvalues", s.negative_eigenvalues},
                   {"factorisations", s.work.factorisations},
                   {"seconds", number(s.seconds)}});
  }
  return out;
}

json iterations(const std::filesystem::path& file) {
  json step = json::array(), iteration = step, energy = step, gradient = step, norm = step, accepted = step;
  if (std::filesystem::exists(file))
    for (const IterationRecord& r : read_iterations(file)) {
      step.push_back(r.load_step);
      iteration.push_back(r.iteration);
      energy.push_back(number(r.energy));
      gradient.push_back(number(r.gradient_norm));
      norm.push_back(number(r.step_norm));
      accepted.push_back(r.accepted ? 1 : 0);
    }
  return {{"load_step", std::move(step)},         {"iteration", std::move(iteration)}, {"energy", std::move(energy)},
          {"gradient_norm", std::move(gradient)}, {"step_norm", std::move(norm)},      {"accepted", std::move(accepted)}};
}

json facts(const Summary& s) {
  json out = json::array();
  const auto add = [&](const std::string& name, const std::string& value) { out.push_back({name, value}); };
  if (std::isfinite(s.energy)) add("energy", fmt::format("{:.10g}", s.energy));
  for (const auto& [name, value] : s.energies)
    if (s.energies.size() > 1) add("energy, " + name, fmt::format("{:.10g}", value));
  for (const auto& [term, parts] : s.parts)
    for (const auto& [name, value] : parts) add(fmt::format("energy, {}, {}", term, name), fmt::format("{:.10g}", value));
  for (const auto& [field, e] : s.errors) add(fmt::format("error of {}", field), fmt::format("{:.4g} in L2, {:.4g} in H1", e.l2, e.h1));
  add("cells", fmt::format("{} of order {}", s.mesh.cells, s.mesh.order));
  add("nodes of the mesh", fmt::format("{}", s.mesh.nodes));
  add("unknowns", fmt::format("{}, {} of them free", s.unknowns, s.free_unknowns));
  add("factorisations", fmt::format("{}", s.work.factorisations));
  add("evaluations", fmt::format("{} Hessians, {} gradients, {} energies", s.work.hessians, s.work.gradients, s.work.energies));
  add("ranks", fmt::format("{}", s.ranks));
  add("peak memory", fmt::format("{:.0f} MB", s.peak_memory_mb));
  return out;
}

/// Stored states to show: the first, the last, and evenly between them.
std::vector<int> thinned(std::size_t count, int most) {
  std::vector<int> out;
  const auto n = std::min(count, static_cast<std::size_t>(std::max(2, most)));
  for (std::size_t k = 0; k < n; ++k) out.push_back(static_cast<int>(n == 1 ? 0 : (k * (count - 1) + (n - 1) / 2) / (n - 1)));
  return out;
}

std::string html_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// The template with its two marks filled in.
std::string filled(const std::string& title, const std::string& data) {
  const std::string_view page = page_template(), title_mark = "@KARCHER_TITLE@", data_mark = "@KARCHER_DATA@";
  const std::size_t a = page.find(title_mark), b = page.find(data_mark);
  std::string out;
  out.reserve(page.size() + data.size() + title.size());
  out += page.substr(0, a);
  out += html_text(title);
  out += page.substr(a + title_mark.size(), b - a - title_mark.size());
  out += data;
  out += page.substr(b + data_mark.size());
  return out;
}

}  // namespace

void write_page(const std::filesystem::path& directory, const PageLimits& limits) {
  const std::filesystem::path summary_file = directory / "summary.json";
  if (!std::filesystem::exists(summary_file))
    throw InputError(fmt::format("The directory {} holds no results: {} is missing.", directory.string(), summary_file.string()));
  const Summary summary = read_results(directory);
  Store store = read_store(directory / "report.data");

  json notes = json::array();
  PageArrays arrays;
  json shape;
  if (!store.states.empty()) {
    const Drawing* curve = draw_as_curves(store);
    const std::vector<int> states = thinned(store.states.size(), limits.states);
    if (states.size() < store.states.size()) notes.push_back(fmt::format("The page shows {} of {} states.", states.size(), store.states.size()));
    const PageGeometry cut = page_geometry(store, states, limits.triangles);
    if (!cut.note.empty()) notes.push_back(cut.note);
    if (!cut.vertices.empty())
      shape = shape_header(store, states, cut, std::max(limits.glyphs, limits.glyph_values / static_cast<int>(states.size())), arrays);
    if (curve && !shape.is_null()) shape["start"]["field"] = "";  // where the curve is tells its values
    if (curve && curve->sphere && !shape.is_null()) shape["sphere"] = true;
  }
  if (store.cut_off) notes.push_back("The last stored state was cut off when the program ended, so it is missing here.");

  const std::filesystem::path problem = directory / "problem.resolved.toml";
  const auto& s = summary.seconds;
  json header = {{"format", 1},
                 {"title", summary.title},
                 {"version", summary.version},
                 {"machine", store.machine},
                 {"status", name(summary.status)},
                 {"result", summary.reason},
                 {"notes", std::move(notes)},
                 {"problem", std::filesystem::exists(problem) ? read_whole(problem) : std::string()},
                 {"facts", facts(summary)},
                 {"seconds",
                  {{"total", s.total},
                   {"setup", s.setup},
                   {"assembly", s.assembly},
                   {"factorisation", s.factorisation},
                   {"solve", s.solve},
                   {"output", s.output}}},
                 {"steps", load_steps(summary, store)},
                 {"iterations", iterations(directory / "iterations.csv")}};
  if (!shape.is_null()) header["shape"] = std::move(shape);
  write_atomically(directory / "report.html", filled(summary.title.empty() ? "Karcher" : summary.title, arrays.packed(std::move(header))));
}

}  // namespace karcher
