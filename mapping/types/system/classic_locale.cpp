// classic_locale.cpp: sets the locale of the calling thread for the duration of a call; other threads keep
// theirs.
#include "mapping/types/system/classic_locale.hpp"

#include <locale.h>

#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace roomradar {
namespace {

locale_t classic_locale() {
  static const locale_t classic = ::newlocale(LC_ALL_MASK, "C", nullptr);
  return classic;
}

}  // namespace

int format_classic(char* to, std::size_t size, const char* format, ...) {
  const locale_t before = ::uselocale(classic_locale());
  std::va_list values;
  va_start(values, format);
  const int length = std::vsnprintf(to, size, format, values);
  va_end(values);
  ::uselocale(before);
  return length;
}

std::string system_reason(int error_number) { return ::strerror_l(error_number, classic_locale()); }

std::string system_reason(const std::error_code& fault) {
  const bool is_of_system =
      fault.category() == std::generic_category() || fault.category() == std::system_category();
  return is_of_system ? system_reason(fault.value()) : fault.message();
}

}  // namespace roomradar
