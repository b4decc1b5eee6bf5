#pragma once
/// \file
/// The memory of this machine, so that what cannot fit is said before it is asked for.

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>

#include "karcher/error.hpp"

namespace karcher {

/// Bytes that this process may have at most: what the machine has, or the limit of its address space (ulimit -v), where that is less.
inline double memory_limit() {
  double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  return bytes;
}

/// "1.5 GB", in powers of 1000.
inline std::string bytes_text(double bytes) {
  static constexpr std::array<const char*, 7> units = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  std::size_t unit = 0;
  for (; bytes >= 999.5 && unit + 1 < units.size(); ++unit) bytes /= 1000;
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

/// \param what  needs the bytes: the subject of the sentence \throws InputError if there are not as many
inline void require_memory(double bytes, const std::string& what) {
  if (!(bytes <= memory_limit()))
    throw InputError(
        fmt::format("{} needs at least about {} of memory; this process may have {}.", what, bytes_text(bytes), bytes_text(memory_limit())));
}

}  // namespace karcher
