// report.hpp: the JSON file that --report writes, with settings, times per stage, memory and results.
#pragma once
#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// Content of a report. `results` is specific to the command. Its keys are merged into the top level of the
/// JSON object.
struct Report {
  std::string command;
  std::string source;
  /// Name of the renderer.
  std::string renderer = "none";
  nlohmann::json settings = nlohmann::json::object();
  std::int64_t frames_read = 0;
  std::int64_t frames_skipped = 0;
  StageTimes times;
  nlohmann::json results = nlohmann::json::object();
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();

  /// Returns the time since the command began.
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  }
};

/// Returns the vector as an array [x, y, z].
nlohmann::json to_json(const Eigen::Vector3d& v);
/// Returns [x, y, z, w].
nlohmann::json to_json(const Eigen::Quaterniond& q);

/// Returns the report as one JSON object, with the current values of peak_rss_mb and wall_s. Numbers that are
/// not finite become null.
nlohmann::json to_json(const Report& report);

/// Throws Error if a file cannot be written at `path`, or if `path` is inside a map's folder. Call before
/// long operations. An empty path is accepted.
void require_writable(const std::filesystem::path& path);

/// Writes the report. Does nothing if `path` is empty. Throws Error if the file cannot be written.
void write_report(const Report& report, const std::filesystem::path& path);

/// Returns the peak resident memory of this process so far, in 10^6 bytes.
double peak_rss_mb();
/// Returns the CPU time of all threads of this process so far, ms.
double process_cpu_ms();

}  // namespace roomradar
