// script_line.cpp: splits a line into words, and names the file and the line in every error.
#include "app/session/script/script_line.hpp"

#include <charconv>
#include <cmath>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result.append(text).append("'");
  return result;
}

LineReader::LineReader(std::string_view text, std::string_view where, int line) : where_(where), line_(line) {
  text = text.substr(0, text.find('#'));
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(" \t\r", begin), text.size());
    words_.push_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
}

void LineReader::fail(const std::string& complaint) const {
  throw Error(std::string(where_) + ":" + std::to_string(line_) + ": " + complaint);
}

std::string_view LineReader::word(const char* wanted) {
  if (done()) fail("the line ends too early; expected " + std::string(wanted));
  return words_[next_++];
}

bool LineReader::take_if(std::string_view expected) {
  if (done() || words_[next_] != expected) return false;
  ++next_;
  return true;
}

void LineReader::expect(std::string_view expected) {
  const std::string_view found = word(in_quotes(expected).c_str());
  if (found != expected) fail("expected " + in_quotes(expected) + ", found " + in_quotes(found));
}

double LineReader::number(const char* wanted, double lowest, double highest) {
  const std::string_view text = word(wanted);
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    fail(in_quotes(text) + " is not a finite number; expected " + wanted);
  if (value < lowest || value > highest) fail(in_quotes(text) + " is out of range for " + wanted);
  return value;
}

double LineReader::whole_number(const char* wanted, double lowest, double highest) {
  const double value = number(wanted, lowest, highest);
  if (value != std::floor(value)) fail("expected a whole number: " + std::string(wanted));
  return value;
}

Eigen::Vector3d LineReader::vector(const char* wanted, double limit) {
  const std::string most = format_general(limit, 6);
  const std::string wanted_each = std::string(wanted) + ", each from -" + most + " to " + most;
  Eigen::Vector3d value;
  for (int axis = 0; axis < 3; ++axis) value[axis] = number(wanted_each.c_str(), -limit, limit);
  return value;
}

void LineReader::expect_end() const {
  if (!done()) fail("unexpected " + in_quotes(words_[next_]) + ": the event is already complete");
}

}  // namespace roomradar
