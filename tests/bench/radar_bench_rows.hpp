// radar_bench_rows.hpp: measured rows: how they are taken, printed and written.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radar_bench_methods.hpp"

namespace roomradar::bench {

struct Row {
  std::string table, method;
  std::size_t scene_triangles = 0, sensor_triangles = 0;
  int radar_px = 0;
  double median_ms = 0, p95_ms = 0;  ///< wall clock
  double cpu_median_ms = 0;          ///< CPU time of the calling thread; ratios are computed from it
  double error_median_m = 0, error_max_m = 0;
  double pixel_m = 0;
  int poses = 0, contacts = 0;
  int false_contacts = 0;  ///< no contact in truth, or > 1 mm early, or overlap of a free pose
  int missed = 0;          ///< reported as free although there is a contact
  bool gives_bounds = true;
  int wrong_bounds = 0;  ///< truth more than 1 um outside [lower_m, upper_m]
};

/// Compares a result with the truth (nullopt: free within the distance; the pose itself is free) and updates
/// the row's counts. Returns the error if both have a contact.
std::optional<double> judge(const Contact& contact, const std::optional<double>& exact_m, Row& row);
void add_errors(std::vector<double> error_m, Row& row);

/// Runs every method on every pose three times, after a warm-up. Methods alternate, so all see the same
/// machine load. Results are checked in the first round. Rows are in the order of the methods; the caller
/// fills in table, scene and sensor.
std::vector<Row> measure(const std::vector<Method>& methods, const std::vector<Pose>& poses,
                         const std::vector<std::optional<double>>& exact_m, int warm_up = 3);

/// @throws Error if the file cannot be written
void write_json(const std::string& path, const std::vector<Row>& rows);

}  // namespace roomradar::bench
