#pragma once
/// \file
/// What a problem file may contain: one table, from which the reader takes the allowed keys and `karcher doc` its pages. Keys of generators and energies are in
/// generators(), energy_catalogue() and load_catalogue().

#include <string>
#include <vector>

namespace karcher::app {

struct KeyInfo {
  std::string name, type;
  std::string standard;  ///< default, as text; "-": must be given
  std::string description;
};

struct SectionInfo {
  std::string name;    ///< "solver"
  std::string header;  ///< "[solver]"
  std::string description;
  std::vector<KeyInfo> keys;
};

const std::vector<SectionInfo>& schema();
const SectionInfo& section_info(const std::string& name);
std::vector<std::string> key_names(const std::string& section);

}  // namespace karcher::app
