#pragma once
/// \file
/// Entries of the catalogue. A source NAME.cpp of this directory defines `std::vector<Entry> NAME_entries()`; CMake finds it by the file's name.

#include <memory>
#include <vector>

#include "karcher/assembly/term.hpp"
#include "karcher/assembly/term_input.hpp"
#include "karcher/energy/energy_info.hpp"

namespace karcher::catalogue {

struct Entry {
  EnergyInfo info;
  std::unique_ptr<Term> (*make)(const EnergyInfo&, const TermInput&) = nullptr;
};

/// What the term tells of itself.
TermInfo term_info(const EnergyInfo& info, const TermInput& input);
/// Keys of all parameters that there are with these choices, in the order of the table, arrays entry by entry: "h", "H[0]", "H[1]", "H[2]".
std::vector<std::string> parameter_keys(const EnergyInfo& info, const TermInput& input);

}  // namespace karcher::catalogue
