// extremes_row.hpp: a row of the table of extremes in the README.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>

namespace roomradar::test {

/// Prints the result of one case beside the expected one.
inline void print_row(const std::string& what, const std::string& expected, const std::string& measured) {
  std::printf("| %s | %s | %s |\n", what.c_str(), expected.c_str(), measured.c_str());
  std::fflush(stdout);
}

inline std::string text(const char* format, double value) {
  char line[80];
  std::snprintf(line, sizeof line, format, value);
  return line;
}

/// Returns true if tests that take minutes are enabled (ROOMRADAR_LONG_TESTS).
inline bool is_long_test() { return std::getenv("ROOMRADAR_LONG_TESTS") != nullptr; }

}  // namespace roomradar::test
