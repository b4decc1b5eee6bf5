#pragma once
/// \file
/// Whether a message says something, with the message in the failure.

#include <gtest/gtest.h>

#include <string>

namespace karcher {

inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

}  // namespace karcher
