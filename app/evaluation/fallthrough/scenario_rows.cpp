// scenario_rows.cpp: one JSON object per scenario.
#include "app/evaluation/fallthrough/scenario_rows.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "roomradar scenarios";
constexpr int kFileVersion = 1;
constexpr std::uintmax_t kLargestFile_bytes = std::uintmax_t{1} << 31U;

/// JSON has no numbers that are not finite.
Json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
}
double number(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const auto& text = value.get_ref<const std::string&>();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return text == "inf" ? kInfinity : text == "-inf" ? -kInfinity : std::numeric_limits<double>::quiet_NaN();
}

template <typename Enum>
Enum one_of(const Json& value, Enum last) {
  const auto index = value.get<int>();
  if (index < 0 || index > static_cast<int>(last)) throw Error("a value is out of its range");
  return static_cast<Enum>(index);
}

Json to_json(const Trial& trial) {
  return {{"travelled_m", number(trial.travelled_m)},
          {"outcome", static_cast<int>(trial.verdict.outcome)},
          {"error_m", number(trial.verdict.error_m)},
          {"rested_on", static_cast<int>(trial.rested_on)},
          {"frame_ms", number(trial.frame_ms)}};
}
Trial trial_from(const Json& json) {
  Trial trial;
  trial.travelled_m = number(json.at("travelled_m"));
  trial.verdict = {one_of(json.at("outcome"), Outcome::kStoppedFalse), number(json.at("error_m"))};
  trial.rested_on = one_of(json.at("rested_on"), SurfaceKind::kInferredBack);
  trial.frame_ms = number(json.at("frame_ms"));
  return trial;
}

Json to_json(const ScenarioRow& row) {
  Json trials = Json::array();
  for (const Trial& trial : row.trials) trials.push_back(to_json(trial));
  return {{"number", row.number},
          {"room", row.room},
          {"room_title", row.room_title},
          {"occluder", static_cast<int>(row.occluder)},
          {"occluder_moves", row.occluder_moves},
          {"shape", static_cast<int>(row.shape)},
          {"is_drop", row.is_drop},
          {"speed_m_s", number(row.speed_m_s)},
          {"true_travel_m", number(row.true_travel_m)},
          {"trials", trials}};
}
ScenarioRow row_from(const Json& json) {
  ScenarioRow row;
  row.number = json.at("number").get<std::int64_t>();
  row.room = json.at("room").get<std::size_t>();
  row.room_title = json.at("room_title").get<std::string>();
  row.occluder = one_of(json.at("occluder"), Occluder::kPerson);
  row.occluder_moves = json.at("occluder_moves").get<bool>();
  row.shape = one_of(json.at("shape"), ObjectShape::kTable);
  row.is_drop = json.at("is_drop").get<bool>();
  row.speed_m_s = number(json.at("speed_m_s"));
  row.true_travel_m = number(json.at("true_travel_m"));
  const Json& trials = json.at("trials");
  if (!trials.is_array() || trials.size() != kPolicyCount) throw Error("a scenario has other policies");
  for (std::size_t i = 0; i < kPolicyCount; ++i) row.trials[i] = trial_from(trials[i]);
  return row;
}

}  // namespace

void write_rows(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path) {
  Json scenarios = Json::array();
  for (const ScenarioRow& row : rows) scenarios.push_back(to_json(row));
  AtomicFile file(path);
  file.stream() << Json{{"format", kFormat}, {"version", kFileVersion}, {"scenarios", scenarios}} << '\n';
  file.commit();
}

std::vector<ScenarioRow> read_rows(const std::filesystem::path& path) {
  const std::string text = read_bytes(path, "results of scenarios", kLargestFile_bytes);
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat || json.at("version") != kFileVersion)
      throw Error("it is of another form");
    std::vector<ScenarioRow> rows;
    for (const Json& row : json.at("scenarios")) rows.push_back(row_from(row));
    return rows;
  } catch (const std::exception& error) {
    throw Error(path.string() + ": is not a file with results of scenarios: " + error.what());
  }
}

}  // namespace roomradar
