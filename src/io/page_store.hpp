#pragma once
/// \file
/// report.data read back: the states of a run at the Lagrange nodes, in single precision.
///
/// File: "KARCHERS" | records. A record: u32 kind (1 description, 2 state), u32 CRC-32 of the payload, u64 bytes of the payload, payload: u32 number of JSON bytes,
/// JSON, then numbers (u32 or f32, as the JSON tells), all little endian.

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "karcher/io/output.hpp"
#include "karcher/io/summary.hpp"

namespace karcher {

struct StoredArray {
  std::string name;
  int components = 1;
};

struct StoredPart {
  std::string region;
  int dim = 0, order = 1;
  std::size_t points = 0;
  std::vector<OutputCell> cells;
  std::vector<float> reference;  ///< [point][3]
  bool moves = false;            ///< the states have displacements
  std::vector<StoredArray> point_data, cell_data;
};

/// Numbers of one part at one state, in the order of StoredPart's lists.
struct StoredValues {
  std::vector<float> displacement;  ///< [point][3]; empty where the part does not move
  std::vector<std::vector<float>> point_data, cell_data;
};

struct StoredState {
  int state = 0;
  double t = 0;
  NamedNumbers energies;
  std::vector<StoredValues> parts;
};

struct Store {
  std::string machine;
  std::map<std::string, Drawing> drawings;        ///< of the fields
  std::vector<std::string> terms, loads;          ///< names of all terms, and of those that are loads
  std::map<std::string, std::string> quantities;  ///< arrays of cell data that are quantities of terms -> their legends
  std::string deformation;                        ///< name of the field that moves the points; empty if there is none
  std::vector<StoredPart> parts;
  std::vector<StoredState> states;
  /// The record that a kill cut off, or damage, ended the reading; what came before is here.
  bool cut_off = false;
};

/// A map from an interval into a plane or into space (Drawing::place) is seen best as the curve it is: where a Store has curves only and nothing moves them, such
/// a field moves them from its place at the first state. Returns its drawing, null if there is nothing of the kind.
const Drawing* draw_as_curves(Store& store);

/// \throws InputError if the file is there and is not of this format. A file that is missing, or whose first record is cut off, gives a Store without parts.
Store read_store(const std::filesystem::path& file);

/// Text and numbers of a record, and the record with its head.
std::string record(std::uint32_t kind, const std::string& json, std::string_view numbers);
inline constexpr std::string_view store_magic = "KARCHERS";
inline constexpr std::uint32_t description_record = 1, state_record = 2;

}  // namespace karcher
