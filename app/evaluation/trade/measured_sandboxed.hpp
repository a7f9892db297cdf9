// measured_sandboxed.hpp: runs a measurement in a child process to measure its memory use separately.
#pragma once
#include <functional>
#include <string>

#include "app/evaluation/pareto/measured_work.hpp"

namespace roomradar {

/// Runs `work` in a child process and returns its result. The calling process must have no GL context, since
/// the child creates its own, and no threads that `work` needs. Throws the Error that `work` throws. Throws
/// Error if the child crashes or takes more than an hour of CPU time.
/// @param what  name of the work in error messages, such as "run in table"
Readings measured_sandboxed(const std::string& what, const std::function<Readings()>& work);

/// Returns the process's peak resident memory minus start_bytes, in 10^6 bytes, >= 0.
double peak_growth_mb(std::size_t start_bytes);

}  // namespace roomradar
