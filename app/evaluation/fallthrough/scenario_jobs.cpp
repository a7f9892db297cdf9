// scenario_jobs.cpp: manifest, and rows of results as JSON.
#include "app/evaluation/fallthrough/scenario_jobs.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/farm/result_rows.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::json;

template <typename Enum>
Enum one_of(const Json& value, Enum last) {
  const auto index = value.get<int>();
  if (index < 0 || index > static_cast<int>(last)) throw Error("a value is out of its range");
  return static_cast<Enum>(index);
}

Json to_json(const Trial& trial) {
  return {{"travelled_m", json_number(trial.travelled_m)},
          {"outcome", static_cast<int>(trial.verdict.outcome)},
          {"error_m", json_number(trial.verdict.error_m)},
          {"rested_on", static_cast<int>(trial.rested_on)},
          {"frame_ms", json_number(trial.frame_ms)}};
}
Trial trial_from(const Json& json) {
  Trial trial;
  trial.travelled_m = number_of(json.at("travelled_m"));
  trial.verdict = {one_of(json.at("outcome"), Outcome::kStoppedFalse), number_of(json.at("error_m"))};
  trial.rested_on = one_of(json.at("rested_on"), SurfaceKind::kInferredBack);
  trial.frame_ms = number_of(json.at("frame_ms"));
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
          {"speed_m_s", json_number(row.speed_m_s)},
          {"true_travel_m", json_number(row.true_travel_m)},
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
  row.speed_m_s = number_of(json.at("speed_m_s"));
  row.true_travel_m = number_of(json.at("true_travel_m"));
  const Json& trials = json.at("trials");
  if (!trials.is_array() || trials.size() != kPolicyCount) throw Error("a scenario has other policies");
  for (std::size_t i = 0; i < kPolicyCount; ++i) row.trials[i] = trial_from(trials[i]);
  return row;
}

constexpr const char* kRooms = "rooms";

/// Calls visit(name, first, last) for each job's scenarios.
template <typename Visit>
void visit_parts(const FallthroughOptions& options, const Visit& visit) {
  for (std::int64_t first = 0; first < options.scenarios; first += options.job_size)
    visit("scenarios-" + format_frame_number(first), first,
          std::min<std::int64_t>(first + options.job_size, options.scenarios) - 1);
}

}  // namespace

void write_rows(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path) {
  Json scenarios = Json::array();
  for (const ScenarioRow& row : rows) scenarios.push_back(to_json(row));
  write_result_rows("scenarios", scenarios, path);
}

std::vector<ScenarioRow> read_rows(const std::filesystem::path& path) {
  return read_result_rows<ScenarioRow>("scenarios", path, row_from);
}

std::string scenario_manifest(const FallthroughOptions& options) {
  const std::string common =
      ": fallthrough --seed " + std::to_string(options.seed) + " --random-rooms " +
      std::to_string(options.random_rooms) +
      (options.radar == RadarMode::kExact ? std::string()
                                          : " --radar " + std::string(to_string(options.radar)));
  std::string manifest = "# Scenarios of roomradar fallthrough, as jobs of roomradar farm.\n";
  manifest += kRooms + common + " --part 0:0 --maps {}/maps --rows {}/rows.json\n";
  visit_parts(options, [&](const std::string& name, std::int64_t first, std::int64_t last) {
    manifest += name + common + " --part " + std::to_string(first) + ":" + std::to_string(last) +
                " --threads 1 --maps {" + kRooms + "}/maps --rows {}/rows.json\n";
  });
  return manifest;
}

std::filesystem::path maps_of_jobs(const std::filesystem::path& folder) { return folder / kRooms / "maps"; }

std::vector<ScenarioRow> joined_rows(const FallthroughOptions& options,
                                     const std::map<std::string, std::string>& faults) {
  const std::size_t rooms = choose_rooms(options.random_rooms).size();
  std::vector<ScenarioRow> rows;
  visit_parts(options, [&](const std::string& name, std::int64_t first, std::int64_t last) {
    if (faults.contains(name)) return;
    const std::filesystem::path file = std::filesystem::path(options.jobs) / name / "rows.json";
    std::vector<ScenarioRow> part = read_rows(file);
    bool is_whole = std::ssize(part) == last - first + 1;
    for (std::size_t i = 0; i < part.size(); ++i)
      is_whole = is_whole && part[i].number == first + static_cast<std::int64_t>(i) &&
                 part[i].room == turn_of(part[i].number, rooms).room;
    if (!is_whole)
      throw Error(file.string() + ": contains scenarios other than " + std::to_string(first) + " to " +
                  std::to_string(last) + "; delete its folder, and run the command again");
    std::move(part.begin(), part.end(), std::back_inserter(rows));
  });
  return rows;
}

}  // namespace roomradar
