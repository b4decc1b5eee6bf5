#pragma once
/// \file
/// Names and texts for people: which names may stand in files, which a user may have meant (the nearest of a list), and the half sentence that error messages end with.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace karcher {

/// ASCII letters only.
inline std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Edit distance with swaps of neighbours (optimal string alignment): the number of letters to insert, delete, replace or swap. Case is ignored.
inline int edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char x, char y) { return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y)); };
  const std::size_t columns = b.size() + 1;
  std::vector<int> before(columns), last(columns), row(columns);
  for (std::size_t j = 0; j < columns; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < columns; ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1])) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

/// Names of regions, fields, probes and parameters have at most as many characters (bytes).
inline constexpr std::size_t longest_name = 100;

/// Letters and digits alone, in lower case: "SO(3)" and "so3" are written for one name.
inline std::string bare(std::string_view name) {
  std::string s;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c))) s += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

/// The candidate of the same letters and digits, else the one with the smallest edit distance, the first of equals; empty when none is near (more than a third of the letters are wrong, at least
/// one wrong letter is always forgiven) or the name is longer than names are.
inline std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::string best;
  if (name.size() > longest_name) return best;
  if (const std::string letters = bare(name); !letters.empty())
    for (const std::string& c : candidates)
      if (bare(c) == letters) return c;
  int smallest = 1 + std::max(1, static_cast<int>(name.size()) / 3);
  for (const std::string& c : candidates) {
    const int d = edit_distance(name, c);
    if (d < smallest && d < static_cast<int>(std::max(name.size(), c.size()))) {
      smallest = d;
      best = c;
    }
  }
  return best;
}

/// Whether text holds control characters (C0, DEL, C1 in UTF-8), which terminals obey and XML cannot hold.
inline bool has_control_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool c1 = c == 0xC2 && i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xE0) == 0x80;
    if (c < 0x20 || c == 0x7F || c1) return true;
  }
  return false;
}

/// The same with every control character but the line end as "\\x1b", for terminals.
inline std::string printable(std::string_view text) {
  std::string s;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool c1 = i + 1 < text.size() && has_control_characters(text.substr(i, 2)) && !has_control_characters(text.substr(i, 1)) &&
                    !has_control_characters(text.substr(i + 1, 1));
    if (text[i] != '\n' && (has_control_characters(text.substr(i, 1)) || c1)) {
      constexpr std::string_view digits = "0123456789abcdef";
      const auto c = static_cast<unsigned char>(text[c1 ? ++i : i]);
      s += {'\\', 'x', digits[c >> 4], digits[c & 15]};
    } else {
      s += text[i];
    }
  }
  return s;
}

/// Whether text is UTF-8 (RFC 3629), as XML and JSON must be.
inline bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U; };
    const std::size_t length = byte(0) < 0x80 ? 1 : byte(0) >> 5 == 0x6 ? 2 : byte(0) >> 4 == 0xE ? 3 : byte(0) >> 3 == 0x1E ? 4 : 0;
    if (length == 0) return false;
    std::uint32_t character = length == 1 ? byte(0) : byte(0) & (0x7FU >> length);
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(k) & 0xC0) != 0x80) return false;
      character = character << 6 | (byte(k) & 0x3F);
    }
    constexpr std::array<std::uint32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
    if (character < least[length] || character > 0x10FFFF || (character >= 0xD800 && character < 0xE000)) return false;
    i += length;
  }
  return true;
}

/// Why a name cannot be given to a region, a field or a probe, as the end of a sentence; empty if it can. Names become parts of file names.
inline std::string fault_of_name(std::string_view name) {
  if (name.empty()) return "is empty";
  if (!is_utf8(name)) return "is not UTF-8";
  if (has_control_characters(name)) return "has control characters";
  return name.size() > longest_name ? "has more than " + std::to_string(longest_name) + " characters" : "";
}

/// The beginning of a long text, for messages.
inline std::string shortened(std::string_view text, std::size_t most = 1000) {
  return text.size() > most ? std::string(text.substr(0, most)) + "..." : std::string(text);
}

/// "a, b, c" for messages that list what is known; of very many, the first.
inline std::string join_names(std::span<const std::string> names, std::string_view separator = ", ") {
  constexpr std::size_t most = 200;
  std::string s;
  for (const std::string& n : names.first(std::min(names.size(), most))) s += (s.empty() ? std::string() : std::string(separator)) + n;
  return names.size() > most ? s + std::string(separator) + "... (" + std::to_string(names.size()) + " in all)" : s;
}

/// "a, b and c"
inline std::string listed(std::span<const std::string> names) {
  std::string s;
  for (std::size_t i = 0; i < names.size(); ++i) s += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return s;
}

/// "Did you mean \"x\"? Known: a, b, c." or, when nothing is near, "Known: a, b, c."
inline std::string suggestion(std::string_view name, std::span<const std::string> candidates, std::string_view known = "Known") {
  const std::string near = nearest_name(name, candidates);
  return (near.empty() ? std::string() : "Did you mean \"" + near + "\"? ") + std::string(known) + ": " + join_names(candidates) + ".";
}

}  // namespace karcher
