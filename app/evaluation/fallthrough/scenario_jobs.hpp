// scenario_jobs.hpp: splits the scenarios of a run into jobs of `roomradar farm`, stores their results in
// files, and merges these.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/cli/options/measuring_options.hpp"
#include "app/evaluation/fallthrough/totals.hpp"

namespace roomradar {

/// Writes rows as JSON. read_rows() reads exactly the same numbers. Throws Error if the file cannot be
/// written.
void write_rows(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path);

/// Reads what write_rows() wrote. Throws Error if the file cannot be read or its contents are not such rows.
std::vector<ScenarioRow> read_rows(const std::filesystem::path& path);

/// Returns the manifest: a job that scans the rooms, and one job per options.job_size scenarios. More
/// scenarios add jobs and leave all full jobs unchanged.
std::string scenario_manifest(const FallthroughOptions& options);

/// Returns the folder of the rooms' maps, which the manifest's first job writes.
std::filesystem::path maps_of_jobs(const std::filesystem::path& folder);

/// Returns the rows of all jobs that have results, in the scenarios' order.
/// @param faults  by name of job: why the job has no results
/// @throws Error if a file is damaged or contains scenarios of another job
std::vector<ScenarioRow> joined_rows(const FallthroughOptions& options,
                                     const std::map<std::string, std::string>& faults);

}  // namespace roomradar
