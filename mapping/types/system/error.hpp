// error.hpp: the project's only exception type, for failures with files, devices and arguments.
#pragma once
#include <stdexcept>
#include <string>

namespace roomradar {

/// A failure that a user can repair. The message says what failed, in which file, field or frame, and how to
/// repair it. Thrown only by code that handles files, devices, settings and arguments. Per-frame code returns
/// status values.
class Error : public std::runtime_error {
 public:
  /// Replaces control characters, which messages quote from damaged files, by '?': a zero would end what()
  /// early, others would change the terminal. Keeps line breaks and tabs.
  explicit Error(const std::string& message);
};

}  // namespace roomradar
