// scenario_jobs.cpp: writes the jobs' names and command lines, and reads their results.
#include "app/evaluation/fallthrough/scenario_jobs.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/evaluation/fallthrough/scenario_rows.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr const char* kRooms = "rooms";

/// Calls visit(name, first, last) for each job's scenarios.
template <typename Visit>
void visit_parts(const FallthroughOptions& options, const Visit& visit) {
  for (std::int64_t first = 0; first < options.scenarios; first += options.job_size)
    visit("scenarios-" + format_frame_number(first), first,
          std::min<std::int64_t>(first + options.job_size, options.scenarios) - 1);
}

}  // namespace

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
