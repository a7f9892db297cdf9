// totals.cpp: counts and medians, as text, JSON and CSV.
#include "app/evaluation/fallthrough/totals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {

ScenarioRow row_of(const Scenario& scenario, std::int64_t number, std::size_t room,
                   const std::string& room_title) {
  ScenarioRow row;
  row.number = number;
  row.room = room;
  row.room_title = room_title;
  row.occluder = scenario.occluder;
  row.occluder_moves = !scenario.occluder_velocity_world.isZero();
  row.shape = scenario.object.shape;
  row.is_drop = scenario.direction_world.z() < -0.99;
  row.speed_m_s = scenario.speed_m_s;
  row.true_travel_m = scenario.true_travel_m;
  return row;
}

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(part * static_cast<double>(values.size()))) - 1;
  const auto at = values.begin() + std::clamp<std::ptrdiff_t>(rank, 0, std::ssize(values) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::string millimetres(double metres) {
  if (!std::isfinite(metres)) return "-";
  std::array<char, 32> text{};
  format_classic(text.data(), text.size(), "%.1f mm", 1e3 * metres);
  return text.data();
}

std::array<PolicyTotals, kPolicyCount> totals_of(const std::vector<ScenarioRow>& rows) {
  std::array<PolicyTotals, kPolicyCount> totals;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    std::vector<double> errors_m, frames_ms, ratios;
    for (const ScenarioRow& row : rows) {
      const Trial& trial = row.trials[i];
      totals[i].passed += trial.verdict.outcome == Outcome::kPassedThrough;
      totals[i].false_stops += trial.verdict.outcome == Outcome::kStoppedFalse;
      if (trial.rested_on != SurfaceKind::kNothing) errors_m.push_back(std::abs(trial.verdict.error_m));
      frames_ms.push_back(trial.frame_ms);
      ratios.push_back(trial.frame_ms / row.trials[0].frame_ms);
    }
    totals[i].contact_error_median_m = percentile(errors_m, 0.5);
    totals[i].contact_error_p95_m = percentile(errors_m, 0.95);
    totals[i].frame_median_ms = percentile(frames_ms, 0.5);
    totals[i].cost_ratio = percentile(ratios, 0.5);
  }
  return totals;
}

std::string table_of(const std::array<PolicyTotals, kPolicyCount>& totals, int scenarios) {
  char line[160];
  std::string table =
      "surfaces       passed through     stopped in empty space     contact error, median and 95 %   frame, "
      "median\n";
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const PolicyTotals& t = totals[i];
    format_classic(line, sizeof line, "%-11s %8d (%5.1f %%) %19d (%5.1f %%)  %13s %13s  %10.1f ms x %.2f\n",
                   std::string(kFallthroughPolicies[i].name).c_str(), t.passed, 100.0 * t.passed / scenarios,
                   t.false_stops, 100.0 * t.false_stops / scenarios,
                   millimetres(t.contact_error_median_m).c_str(), millimetres(t.contact_error_p95_m).c_str(),
                   t.frame_median_ms, t.cost_ratio);
    table += line;
  }
  return table;
}

nlohmann::json to_json(const std::array<PolicyTotals, kPolicyCount>& totals) {
  nlohmann::json json = nlohmann::json::object();
  for (std::size_t i = 0; i < kPolicyCount; ++i)
    json[std::string(kFallthroughPolicies[i].name)] = {
        {"passed", totals[i].passed},
        {"false_stops", totals[i].false_stops},
        {"contact_error_median_m", totals[i].contact_error_median_m},
        {"contact_error_p95_m", totals[i].contact_error_p95_m},
        {"frame_median_ms", totals[i].frame_median_ms},
        {"frame_ratio", totals[i].cost_ratio}};
  return json;
}

nlohmann::json failures_of(const std::vector<ScenarioRow>& rows) {
  nlohmann::json failures = nlohmann::json::array();
  for (const ScenarioRow& row : rows)
    for (std::size_t i = 0; i < kPolicyCount; ++i) {
      const Trial& trial = row.trials[i];
      if (trial.verdict.outcome == Outcome::kStoppedRight) continue;
      failures.push_back({{"scenario", row.number},
                          {"room", row.room_title},
                          {"occluder", to_string(row.occluder)},
                          {"shape", to_string(row.shape)},
                          {"surfaces", kFallthroughPolicies[i].name},
                          {"outcome", to_string(trial.verdict.outcome)},
                          {"rested_on", to_string(trial.rested_on)},
                          {"error_m", trial.verdict.error_m}});
    }
  return failures;
}

void write_csv(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path) {
  if (path.empty()) return;
  AtomicFile whole(path);
  std::ostream& file = whole.stream();
  file << "scenario,room,occluder,occluder_moves,shape,motion,speed_m_s,true_travel_m,surfaces,outcome,"
          "travelled_m,error_m,rested_on,frame_ms\n";
  char numbers[120];
  for (const ScenarioRow& row : rows)
    for (std::size_t i = 0; i < kPolicyCount; ++i) {
      const Trial& trial = row.trials[i];
      file << row.number << ',' << row.room_title << ',' << to_string(row.occluder) << ','
           << (row.occluder_moves ? "yes" : "no") << ',' << to_string(row.shape) << ','
           << (row.is_drop ? "drop" : "push") << ',';
      format_classic(numbers, sizeof numbers, "%.3f,%.5f", row.speed_m_s, row.true_travel_m);
      file << numbers << ',' << kFallthroughPolicies[i].name << ',' << to_string(trial.verdict.outcome)
           << ',';
      format_classic(numbers, sizeof numbers, "%.5f,%.5f", trial.travelled_m, trial.verdict.error_m);
      file << numbers << ',' << to_string(trial.rested_on) << ',';
      format_classic(numbers, sizeof numbers, "%.2f", trial.frame_ms);
      file << numbers << '\n';
    }
  whole.commit();
}

}  // namespace roomradar
