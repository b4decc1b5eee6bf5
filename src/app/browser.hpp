#pragma once
/// \file
/// A Chromium without a window, spoken to over a pipe in the Chrome DevTools Protocol (https://chromedevtools.github.io/devtools-protocol/).

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace karcher::app {

/// $KARCHER_CHROMIUM, or the first of chromium, chromium-browser, google-chrome, google-chrome-stable in $PATH; empty if there is none.
std::filesystem::path find_browser();

class Browser {
 public:
  /// Starts the program with an empty profile of its own. \throws Error if it does not start.
  explicit Browser(const std::filesystem::path& program, std::chrono::seconds patience = std::chrono::seconds(90));
  /// Ends the program and removes its profile.
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a page and gives the value that a JavaScript expression has there (of its promise, if it is one); the expression may be evaluated more than once
  /// while the page is loading. \throws InputError with the page's own words if it rejects; Error if the browser ends or keeps silent.
  std::string evaluate(const std::string& url, const std::string& expression);

 private:
  nlohmann::json command(const std::string& method, const nlohmann::json& parameters, const std::string& session = {});
  std::string read_message();

  std::filesystem::path profile_;
  std::chrono::steady_clock::time_point deadline_;
  int process_ = -1, to_ = -1, from_ = -1, last_id_ = 0;
  std::string buffer_;
};

/// file:// address of a path, percent-encoded.
std::string file_url(const std::filesystem::path& path);
/// Everything but letters, digits and -._~/ as %XX.
std::string percent_encoded(std::string_view text);

}  // namespace karcher::app
