// scan_resources.hpp: estimates how long a scan can continue until memory or disk run out.
#pragma once
#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>

namespace roomradar {

/// Memory and disk space in bytes, at time time_s.
struct ScanResources {
  double time_s = 0.0;
  double memory_used = 0.0;
  double memory_limit = 0.0;
  double disk_free = 0.0;
};

/// Returns the resources of this process now.
/// @param max_memory_bytes  cap on the process's memory; 0: the machine's free memory
/// @param folder  an existing folder on the disk that the scan writes to
ScanResources resources_now(double time_s, std::size_t max_memory_bytes, const std::filesystem::path& folder);

/// Extrapolates the use of memory and disk over the last minute.
class ResourceForecast {
 public:
  /// Call about every second; times must not decrease.
  void add(const ScanResources& now);
  /// Returns the time until memory or disk space is exhausted at the present rate, s. Returns nullopt within
  /// the first 20 s, and if neither decreases noticeably.
  [[nodiscard]] std::optional<double> left_s() const;

 private:
  std::deque<ScanResources> last_minute_;
};

}  // namespace roomradar
