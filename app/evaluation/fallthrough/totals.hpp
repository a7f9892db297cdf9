// totals.hpp: what came of all trials: a table, a report, a file of rows.
#pragma once
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/policies.hpp"
#include "app/evaluation/fallthrough/trial.hpp"

namespace roomradar {

/// One scenario under all policies; what of it the tables and plots need.
struct ScenarioRow {
  std::int64_t number = 0;  ///< of the run
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
  /// Of those that something stopped, how far from the truth; NaN where nothing was stopped.
  double contact_error_median_m = 0.0;
  double contact_error_p95_m = 0.0;
  double frame_median_ms = 0.0;
  double cost_ratio = 0.0;  ///< median, scenario by scenario, of the frame's time to the first policy's
};
std::array<PolicyTotals, kPolicyCount> totals_of(const std::vector<ScenarioRow>& rows);

/// Nearest rank, 0 <= part <= 1; NaN for no values.
double percentile(std::vector<double> values, double part);
/// "3.2 mm"; "-" for what is not known.
std::string millimetres(double metres);

std::string table_of(const std::array<PolicyTotals, kPolicyCount>& totals, int scenarios);
/// `policies` of the report, and `failures`: each trial that was not right.
nlohmann::json to_json(const std::array<PolicyTotals, kPolicyCount>& totals);
nlohmann::json failures_of(const std::vector<ScenarioRow>& rows);
/// One line a scenario and policy, with a header. Throws Error if the file cannot be written.
void write_csv(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path);

}  // namespace roomradar
