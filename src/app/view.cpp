#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>

#include "app/browser.hpp"
#include "app/verbs.hpp"
#include "karcher/error.hpp"
#include "karcher/io/atomic_file.hpp"
#include "karcher/io/page.hpp"
#include "karcher/text.hpp"

namespace karcher::app {
namespace {

enum class Setting { flag, number, text };

/// The settings of the page: the members of View in viewer/src/view.ts but field and state, and what its addresses may hold besides.
const std::map<std::string, Setting>& known_settings() {
  using enum Setting;
  static const std::map<std::string, Setting> all{
      {"range", text},       {"logarithmic", flag},    {"clipOutliers", flag}, {"smooth", flag},   {"map", text},
      {"surface", flag},     {"edges", flag},          {"opacity", number},    {"scale", number},  {"glyphs", text},
      {"glyphSize", number}, {"clip", text},           {"clipAt", number},     {"clipFlip", flag}, {"axes", flag},
      {"trail", flag},       {"glyphDensity", number}, {"zoom", number},       {"up", text}};
  return all;
}

void check_setting(const std::string& name, const std::string& value) {
  const auto found = known_settings().find(name);
  if (found == known_settings().end()) {
    std::vector<std::string> names;
    for (const auto& entry : known_settings()) names.push_back(entry.first);
    throw InputError("--show: the page has no setting \"" + name + "\". " + suggestion(name, names, "Settings"));
  }
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool is_number = error == std::errc() && end == value.data() + value.size() && std::isfinite(number);
  if (found->second == Setting::number && !is_number) throw InputError(fmt::format("--show {} takes a number, not \"{}\".", name, value));
  if (found->second == Setting::flag && value != "0" && value != "1" && value != "true" && value != "false")
    throw InputError(fmt::format("--show {} takes 0 or 1, not \"{}\".", name, value));
}

std::string fragment(const ViewOptions& options) {
  std::string out = "#picture";
  const auto add = [&](const std::string& name, const std::string& value) { out += '&' + name + '=' + percent_encoded(value); };
  if (options.view) add("view", fmt::format("{},{},{}", (*options.view)[0], (*options.view)[1], (*options.view)[2]));
  if (!options.field.empty()) add("field", options.field);
  if (options.step) add("step", fmt::format("{}", *options.step));
  add("theme", options.dark ? "dark" : "light");
  for (const auto& [name, value] : options.settings) add(name, value);
  return out;
}

/// The bytes of base64 text (RFC 4648, with padding); empty where it is none.
std::string from_base64(const std::string& text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) return {};
    bits = (bits << 6 | static_cast<unsigned>(digit)) & 0xffff;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out += static_cast<char>(bits >> held & 0xff);
  }
  return out;
}

}  // namespace

int view(const ViewOptions& options) {
  if (!std::filesystem::is_directory(options.directory))
    throw InputError(fmt::format("{} is not a directory with results.", options.directory.string()));
  if (options.view && (*options.view)[0] == 0 && (*options.view)[1] == 0 && (*options.view)[2] == 0)
    throw InputError("The direction of view 0,0,0 is none; give for instance 1,-1,0.5.");
  for (const int pixels : {options.width, options.height})
    if (pixels < 64 || pixels > 8192)
      throw InputError(fmt::format("A picture of {} by {} pixels cannot be made; both must be 64 to 8192.", options.width, options.height));
  for (const auto& [name, value] : options.settings) check_setting(name, value);
  if (!options.png.empty() && lower_case(options.png.extension().string()) != ".png")
    throw InputError(fmt::format("--png {}: pictures are written in the PNG format, so the file must end in .png.", options.png.string()));
  write_page(options.directory);
  const std::filesystem::path page = options.directory / "report.html";
  if (options.png.empty()) {
    fmt::print("{}\n", page.string());
    return 0;
  }
  const std::filesystem::path program = find_browser();
  if (program.empty())
    throw InputError(
        "A picture needs Chromium, and there is none here. Install it (on Debian: apt-get install chromium), or name a browser of its family in the "
        "environment variable KARCHER_CHROMIUM. The page " +
        page.string() + " is made and can save pictures itself.");
  Browser browser(program);
  const std::string text = browser.evaluate(file_url(page) + fragment(options),
                                            fmt::format("(async () => {{ while (!window.karcher) await new Promise((r) => setTimeout(r, 20)); await "
                                                        "window.karcher.ready; return window.karcher.picture({}, {}); }})()",
                                                        options.width, options.height));
  const std::string png = from_base64(text);
  if (png.size() < 8 || png.compare(1, 3, "PNG") != 0) throw Error("The browser gave no picture.");
  write_atomically(options.png, png);
  fmt::print("{}\n", options.png.string());
  return 0;
}

}  // namespace karcher::app
