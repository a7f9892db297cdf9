// totals.hpp: results of all trials as a table, a report and a CSV file.
#pragma once
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/policies.hpp"
#include "app/evaluation/fallthrough/trial.hpp"

namespace roomradar {

/// Results of one scenario with all policies, for tables and plots.
struct ScenarioRow {
  std::int64_t number = 0;  ///< the scenario's number in the run
  std::size_t room = 0;     ///< index among the run's rooms
  std::string room_title;
  Occluder occluder = Occluder::kFurniture;
  bool occluder_moves = false;
  ObjectShape shape = ObjectShape::kBall;
  bool is_drop = false;
  double speed_m_s = 0.0;
  double true_travel_m = 0.0;
  std::array<Trial, kPolicyCount> trials;
};
ScenarioRow row_of(const Scenario& scenario, std::int64_t number, std::size_t room,
                   const std::string& room_title);

struct PolicyTotals {
  int passed = 0;
  int false_stops = 0;
  /// Median of |travelled distance - true distance| over the objects that stopped; NaN if none stopped.
  double contact_error_median_m = 0.0;
  double contact_error_p95_m = 0.0;
  double frame_median_ms = 0.0;
  /// Median over scenarios of the ratio of frame_ms to that of the first policy.
  double cost_ratio = 0.0;
};
std::array<PolicyTotals, kPolicyCount> totals_of(const std::vector<ScenarioRow>& rows);

/// Returns the nearest-rank quantile at the fraction `part`, 0 to 1; NaN if there are no values.
double percentile(std::vector<double> values, double part);
/// Returns text such as "3.2 mm", or "-" for a value that is not finite.
std::string millimetres(double metres);

std::string table_of(const std::array<PolicyTotals, kPolicyCount>& totals, int scenarios);
/// Returns the value of the report's key `policies`.
nlohmann::json to_json(const std::array<PolicyTotals, kPolicyCount>& totals);
/// Returns the value of the report's key `failures`: all trials with an outcome other than kStoppedRight.
nlohmann::json failures_of(const std::vector<ScenarioRow>& rows);
/// Writes a CSV file with one line per scenario and policy. Does nothing if `path` is empty. Throws Error if
/// the file cannot be written.
void write_csv(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path);

}  // namespace roomradar
