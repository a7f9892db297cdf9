// radar_bench_rows.hpp: measured cells: how they are taken, printed and written.
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
  double cpu_median_ms = 0;          ///< of the calling thread: what ratios are made of
  double error_median_m = 0, error_max_m = 0;
  double pixel_m = 0;
  int poses = 0, contacts = 0;
  int false_contacts =
      0;           ///< said to touch where nothing is or 1 mm before it does, or to overlap what is free
  int missed = 0;  ///< said to be free where something is
  bool gives_bounds = true;
  int wrong_bounds = 0;  ///< truth more than 1 um outside lower_m .. upper_m
};

/// One answer against the truth (nothing: free within the distance; the pose itself is free): its error, if
/// both touch, and counts into the row.
std::optional<double> judge(const Contact& contact, const std::optional<double>& exact_m, Row& row);
void add_errors(std::vector<double> error_m, Row& row);

/// Every method on every pose three times over, after a warm-up; methods take turns, so that all meet the
/// same load. Answers are judged in the first round. Rows come in the methods' order; table, scene and sensor
/// are the caller's.
std::vector<Row> measure(const std::vector<Method>& methods, const std::vector<Pose>& poses,
                         const std::vector<std::optional<double>>& exact_m, int warm_up = 3);

/// @throws Error if the file cannot be written
void write_json(const std::string& path, const std::vector<Row>& rows);

}  // namespace roomradar::bench
