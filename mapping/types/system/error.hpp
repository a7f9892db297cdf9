// error.hpp: the one exception type of the project, for where it meets files, devices and arguments.
#pragma once
#include <stdexcept>
#include <string>

namespace roomradar {

/// A failure that a user can act on. The message says what failed, where (file, field, frame) and what to do
/// about it. Thrown at the boundary only; the per-frame path answers with status values.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace roomradar
