#pragma once
/// \file
/// report.html: the page that opens by double click. It is made of what stands in the results directory: summary.json, iterations.csv, problem.resolved.toml and
/// report.data, the states that PageStates keeps for it. So it can be made again at any time (`karcher view`), also after a run that failed, was interrupted or killed.
///
///   PageStates states(directory, model);                          // on the rank that writes
///   states.write(0, 0.0, parts);                                  // initial configuration, then every load step
///   ...
///   write_page(directory);                                        // after summary.json

#include <filesystem>
#include <string>
#include <vector>

#include "karcher/io/output.hpp"
#include "karcher/io/summary.hpp"

namespace karcher {

/// report.data: single precision copies of the states, one record after the other; a killed program leaves whole records and at most one that is ignored.
class PageStates {
 public:
  /// Starts a new file; with first_state > 0 (a resumed run) keeps the records of earlier states. \throws Error if the file cannot be written.
  PageStates(std::filesystem::path directory, const OutputModel& model, int first_state = 0);

  /// \param state 0: initial configuration, then the number of the load step
  /// \param parts from OutputSampler::sample; regions, cells and names of arrays are those of the first call
  /// \param energies of the terms at this state, for the diagram (may be empty)
  void write(int state, double t, const std::vector<OutputPart>& parts, const NamedNumbers& energies = {});

 private:
  std::filesystem::path file_;
  std::string description_;  ///< JSON of the fields, until the first state is written
  bool described_ = false;
};

/// What a page shows at most; more is thinned, with a note in the page.
struct PageLimits {
  int triangles = 200000;
  int states = 60;
  int glyphs = 3000;         ///< of a field; more where there are few states:
  int glyph_values = 40000;  ///< glyphs times states
};

/// Makes <directory>/report.html, atomically.
/// \throws InputError if the directory holds no summary.json or one of the files is not of its format; Error if the page cannot be written.
void write_page(const std::filesystem::path& directory, const PageLimits& limits = {});

/// The committed page without data (viewer/dist/page.html), embedded in the library.
std::string_view page_template();

}  // namespace karcher
