// measured_sandboxed.hpp: a measurement in a process of its own, so that none finds the memory of another.
#pragma once
#include <functional>
#include <string>

#include "app/evaluation/pareto/measured_setting.hpp"

namespace roomradar {

/// What `work` returns, computed in a child of this process, which must not have a GL context (nor threads
/// that the work needs): the child makes its own. What it throws as Error is thrown here; if it crashes that
/// is an Error, too.
/// @param what  for messages: "run in table"
Readings measured_sandboxed(const std::string& what, const std::function<Readings()>& work);

/// How much more memory (10^6 bytes) this process has held at its peak than it held at `start_bytes`.
double peak_growth_mb(std::size_t start_bytes);

}  // namespace roomradar
