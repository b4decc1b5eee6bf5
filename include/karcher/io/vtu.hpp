#pragma once
/// \file
/// Results for ParaView: one .vtu per part and load step, and a .pvd collection with the values of t.
///
/// Cells are VTK's Lagrange cells of order 1 to 3. Data is inline base64, compressed by zlib (format="binary", vtkZLibDataCompressor), Float64.
/// The writer is serial: on several ranks one of them, with complete values, writes.

#include <filesystem>
#include <string>
#include <vector>

#include "karcher/io/output.hpp"

namespace karcher {

/// VTK's number of the Lagrange cell of a kind (68 to 72; 1 for a vertex).
int vtk_cell_type(CellKind kind);
/// Our local node number (reference_cell.hpp) at each place of VTK's Lagrange cell of this kind and order.
const std::vector<int>& vtk_node_order(CellKind kind, int order);

/// Writes one part atomically. t is stored as field data "TimeValue".
void write_vtu(const std::filesystem::path& file, const OutputPart& part, double t);

/// A part as write_vtu wrote it (its region stands in the collection only). \throws InputError naming the file if it is missing, damaged or not of write_vtu
OutputPart read_vtu(const std::filesystem::path& file);

/// One file of a collection.
struct VtuEntry {
  int state = 0, part = 0;
  double t = 0;
  std::string region;  ///< of the part, without the characters that file names may not have
  std::string file;    ///< relative to the collection
};

/// Removes the file of an entry, unless the collection names one in another directory.
void remove_state(const std::filesystem::path& directory, const VtuEntry& entry);

/// What a .pvd written by VtuSeries lists, in the order of states and parts. \throws InputError if it is missing or was not written by VtuSeries.
std::vector<VtuEntry> read_collection(const std::filesystem::path& file);

/// The files of a run: <directory>/<stem>.pvd and <directory>/<stem>_0000.vtu, <stem>_0000.<region>.vtu for further parts.
class VtuSeries {
 public:
  explicit VtuSeries(std::filesystem::path directory, const std::string& stem = "solution");
  /// Continues the collection of an interrupted run: keeps its entries of states before `first_state` whose files are there, and removes the
  /// files of later ones. \throws InputError if the .pvd is not ours.
  void resume(int first_state);
  /// Writes state number `state` (0: initial configuration, k: end of load step k) and updates the collection atomically.
  void write(int state, double t, const std::vector<OutputPart>& parts);

 private:
  std::filesystem::path directory_;
  std::string stem_;
  std::vector<VtuEntry> entries_;
};

}  // namespace karcher
