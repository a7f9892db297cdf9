// measured_sandboxed.hpp: runs a measurement in a child process, so its memory use is measured alone.
#pragma once
#include <functional>
#include <string>

#include "app/evaluation/pareto/measured_setting.hpp"

namespace roomradar {

/// Runs `work` in a child process and returns its result. This process must have no GL context (the child
/// creates its own), and no threads that the work needs. Rethrows Error from the work; throws Error if the
/// child crashes.
/// @param what  for messages: "run in table"
Readings measured_sandboxed(const std::string& what, const std::function<Readings()>& work);

/// Returns the process's peak resident memory minus start_bytes, in 10^6 bytes, at least 0.
double peak_growth_mb(std::size_t start_bytes);

}  // namespace roomradar
