// error.cpp: keeps messages printable.
#include "mapping/types/system/error.hpp"

#include <algorithm>

namespace roomradar {
namespace {

std::string printable(std::string message) {
  std::replace_if(
      message.begin(), message.end(),
      [](char c) { return (c >= 0 && c < ' ' && c != '\n' && c != '\t') || c == 0x7F; }, '?');
  return message;
}

}  // namespace

Error::Error(const std::string& message) : std::runtime_error(printable(message)) {}

}  // namespace roomradar
