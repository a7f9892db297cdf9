// scan_resources.cpp: reads free memory and disk, and extrapolates their use.
#include "app/scan/live/scan_resources.hpp"

#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "mapping/types/system/process_memory.hpp"

namespace roomradar {

ScanResources resources_now(double time_s, std::size_t max_memory_bytes,
                            const std::filesystem::path& folder) {
  ScanResources now;
  now.time_s = time_s;
  now.memory_used = static_cast<double>(resident_bytes());
  const double free =
      static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  now.memory_limit = max_memory_bytes > 0 ? static_cast<double>(max_memory_bytes) : now.memory_used + free;
  std::error_code ignored;
  const std::filesystem::space_info disk = std::filesystem::space(folder, ignored);
  now.disk_free = ignored ? 0.0 : static_cast<double>(disk.available);
  return now;
}

void ResourceForecast::add(const ScanResources& now) {
  constexpr double kOver_s = 60.0;
  last_minute_.push_back(now);
  while (now.time_s - last_minute_.front().time_s > kOver_s) last_minute_.pop_front();
}

std::optional<double> ResourceForecast::left_s() const {
  constexpr double kFrom_s = 20.0, kLeast_bytes_s = 1e5;
  if (last_minute_.empty()) return std::nullopt;
  const ScanResources &first = last_minute_.front(), &now = last_minute_.back();
  const double passed_s = now.time_s - first.time_s;
  if (passed_s < kFrom_s) return std::nullopt;
  std::optional<double> least;
  const auto take = [&](double left, double used) {
    const double rate = used / passed_s;
    if (rate < kLeast_bytes_s) return;
    const double left_s = std::max(left, 0.0) / rate;
    least = least ? std::min(*least, left_s) : left_s;
  };
  take(now.memory_limit - now.memory_used, now.memory_used - first.memory_used);
  take(now.disk_free, first.disk_free - now.disk_free);
  return least;
}

}  // namespace roomradar
