// report.hpp: the JSON file that --report leaves: settings, times of each stage, memory, results.
#pragma once
#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// The keys that every command's report has. The command adds its own to `results`, which are merged at top
/// level.
struct Report {
  std::string command;
  std::string source;
  std::string renderer = "none";
  nlohmann::json settings = nlohmann::json::object();
  std::int64_t frames_read = 0;
  std::int64_t frames_skipped = 0;
  StageTimes times;
  nlohmann::json results = nlohmann::json::object();
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
};

/// [x, y, z].
nlohmann::json to_json(const Eigen::Vector3d& v);

/// All of it as one object; peak_rss_mb and wall_s are taken now. A number that is not finite becomes null.
nlohmann::json to_json(const Report& report);

/// Throws Error if a file cannot be written there, or should not, because it would lie in a map's folder: a
/// check to make before minutes of work. An empty path is fine.
void require_writable(const std::filesystem::path& path);

/// Writes the report, or does nothing for an empty path. Throws Error if the file cannot be written.
void write_report(const Report& report, const std::filesystem::path& path);

/// Largest resident memory of this process so far, in 10^6 bytes.
double peak_rss_mb();
/// What all threads of this process have computed so far.
double process_cpu_ms();

}  // namespace roomradar
