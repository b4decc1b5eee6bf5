#pragma once
/// \file
/// Files that are whole or absent: a reader (or a kill) at any moment finds the previous content or the new one, never a part.

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace karcher {

/// Writes to a temporary file in the same directory, flushes it to the disk and renames it over `path`.
/// \throws Error naming the file and what the system said; `path` is unchanged then and no temporary file is left.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Whole content of a file. \param most  bytes that it may have: devices have no end
/// \throws InputError naming the file and what the system said, or that it has more
std::string read_whole(const std::filesystem::path& path, std::size_t most = std::numeric_limits<std::size_t>::max() - 1);

}  // namespace karcher
