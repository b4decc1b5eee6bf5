#include "karcher/catalogue/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catalogue/entry.hpp"
#include "karcher/error.hpp"
#include "karcher/text.hpp"

namespace karcher {

// Of every other source of this directory.
#define KARCHER_ENTRIES(name)          \
  namespace catalogue {                \
  std::vector<Entry> name##_entries(); \
  }
#include "catalogue_entries.inc"
#undef KARCHER_ENTRIES

namespace {

const std::vector<catalogue::Entry>& entries() {
  static const std::vector<catalogue::Entry> all = [] {
    std::vector<catalogue::Entry> list;
    const auto append = [&](std::vector<catalogue::Entry> more) {
      for (catalogue::Entry& e : more) list.push_back(std::move(e));
    };
#define KARCHER_ENTRIES(name) append(catalogue::name##_entries());
#include "catalogue_entries.inc"
#undef KARCHER_ENTRIES
    return list;
  }();
  return all;
}

const catalogue::Entry& entry(const std::string& name) {
  std::vector<std::string> known;
  for (const catalogue::Entry& e : entries()) {
    known.push_back(e.info.term_name());
    if (known.back() == name) return e;
  }
  throw InputError("There is no energy or load \"" + name + "\". " + suggestion(name, known));
}

std::vector<EnergyInfo> infos(bool loads) {
  std::vector<EnergyInfo> list;
  for (const catalogue::Entry& e : entries())
    if (e.info.load == loads) list.push_back(e.info);
  return list;
}

}  // namespace

namespace catalogue {

TermInfo term_info(const EnergyInfo& info, const TermInput& input) {
  TermInfo term{info.term_name(), info.parts, {}, info.load, {}};
  for (std::size_t slot = 0; slot < info.fields.size(); ++slot) {
    if (info.fields[slot].headless) term.headless.push_back(input.fields[slot]);
    if (info.fields[slot].moves) term.moving.push_back(input.fields[slot]);
  }
  return term;
}

std::vector<std::string> parameter_keys(const EnergyInfo& info, const TermInput& input) {
  std::vector<std::string> keys;
  for (const Parameter& p : info.parameters) {
    if (p.only && !p.only->holds(input.choices)) continue;
    const int size = p.size == Parameter::ambient ? input.field(0).manifold->ambient : p.size;
    if (p.size == 1) keys.push_back(p.name);
    for (int i = 0; i < size && p.size != 1; ++i) keys.push_back(fmt::format("{}[{}]", p.name, i));
  }
  return keys;
}

}  // namespace catalogue

const std::vector<EnergyInfo>& energy_catalogue() {
  static const std::vector<EnergyInfo> list = infos(false);
  return list;
}

const std::vector<EnergyInfo>& load_catalogue() {
  static const std::vector<EnergyInfo> list = infos(true);
  return list;
}

std::unique_ptr<Term> make_term(const EnergyInfo& info, TermInput input) { return entry(info.term_name()).make(info, input); }

std::unique_ptr<Term> make_term(const std::string& name, TermInput input) { return make_term(entry(name).info, std::move(input)); }

}  // namespace karcher
