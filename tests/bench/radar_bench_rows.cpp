// radar_bench_rows.cpp: times a call by two clocks and compares its result with the truth.
#include "radar_bench_rows.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "mapping/types/system/error.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"

namespace roomradar::bench {

std::optional<double> judge(const Contact& contact, const std::optional<double>& exact_m, Row& row) {
  constexpr double kRounding_m = 1e-6, kPhantom_m = 1e-3;
  ++row.poses;
  row.pixel_m = std::max(row.pixel_m, contact.pixel_m);
  if (row.gives_bounds) {
    const bool hold =
        exact_m ? contact.lower_m <= *exact_m + kRounding_m && contact.upper_m >= *exact_m - kRounding_m
                : !std::isfinite(contact.upper_m);
    row.wrong_bounds += hold ? 0 : 1;
  }
  const bool is_overlap = contact.status == ContactStatus::kOverlap;
  if (is_overlap || (contact && (!exact_m || contact.contact_distance_m < *exact_m - kPhantom_m)))
    ++row.false_contacts;
  if (!contact && exact_m) ++row.missed;
  if (!contact || !exact_m) return std::nullopt;
  ++row.contacts;
  return std::abs(contact.contact_distance_m - *exact_m);
}

void add_errors(std::vector<double> error_m, Row& row) {
  row.error_median_m = test::quantile(error_m, 0.5);
  row.error_max_m = test::quantile(std::move(error_m), 1.0);
}

std::vector<Row> measure(const std::vector<Method>& methods, const std::vector<Pose>& poses,
                         const std::vector<std::optional<double>>& exact_m, int warm_up) {
  using Clock = std::chrono::steady_clock;
  constexpr int kRounds = 3;
  struct Samples {
    std::vector<double> wall_ms, cpu_ms, error_m;
  };
  std::vector<Row> rows(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) rows[m].gives_bounds = methods[m].gives_bounds;
  std::vector<Samples> samples(methods.size());
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      for (int i = 0; i < warm_up; ++i)
        static_cast<void>(methods[m].query(poses[static_cast<std::size_t>(i) % poses.size()]));
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto start = Clock::now();
        const double start_cpu_ms = test::thread_ms();
        const Contact contact = methods[m].query(poses[i]);
        samples[m].cpu_ms.push_back(test::thread_ms() - start_cpu_ms);
        samples[m].wall_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
        if (round > 0) continue;  // the results repeat
        if (const auto error_m = judge(contact, exact_m[i], rows[m])) samples[m].error_m.push_back(*error_m);
      }
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    Row& row = rows[m];
    row.method = methods[m].name;
    row.radar_px = methods[m].radar_px;
    row.median_ms = test::quantile(samples[m].wall_ms, 0.5);
    row.p95_ms = test::quantile(samples[m].wall_ms, 0.95);
    row.cpu_median_ms = test::quantile(samples[m].cpu_ms, 0.5);
    add_errors(samples[m].error_m, row);
  }
  return rows;
}

void write_json(const std::string& path, const std::vector<Row>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& r : rows) {
    list.push_back({{"table", r.table},
                    {"method", r.method},
                    {"scene_triangles", r.scene_triangles},
                    {"sensor_triangles", r.sensor_triangles},
                    {"radar_px", r.radar_px},
                    {"median_ms", r.median_ms},
                    {"p95_ms", r.p95_ms},
                    {"cpu_median_ms", r.cpu_median_ms},
                    {"error_median_m", r.error_median_m},
                    {"error_max_m", r.error_max_m},
                    {"pixel_m", r.pixel_m},
                    {"poses", r.poses},
                    {"contacts", r.contacts},
                    {"false_contacts", r.false_contacts},
                    {"missed", r.missed},
                    {"wrong_bounds",
                     r.gives_bounds ? nlohmann::ordered_json(r.wrong_bounds) : nlohmann::ordered_json()}});
  }
  test::write_rows(path, list);
}

}  // namespace roomradar::bench
