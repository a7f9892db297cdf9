// classic_locale.hpp: text in the classic ("C") locale, whatever locale the host program has set.
#pragma once
#include <cstddef>
#include <string>
#include <system_error>

namespace roomradar {

/// Formats as std::snprintf does in the classic locale: "1.5", never "1,5". The program itself keeps the
/// classic locale; a program that loads the library, such as Python, may have set another.
[[gnu::format(printf, 3, 4)]] int format_classic(char* to, std::size_t size, const char* format, ...);

/// Returns the system's text of an error number in English, such as "No such file or directory".
[[nodiscard]] std::string system_reason(int error_number);
[[nodiscard]] std::string system_reason(const std::error_code& fault);

}  // namespace roomradar
