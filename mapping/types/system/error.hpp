// error.hpp: the project's only exception type, for failures with files, devices and arguments.
#pragma once
#include <stdexcept>
#include <string>

namespace roomradar {

/// A failure that a user can act on. The message says what failed, in which file, field or frame, and what to
/// do about it. Thrown only at the program's boundary; per-frame code returns status values.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace roomradar
