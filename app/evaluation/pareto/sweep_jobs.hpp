// sweep_jobs.hpp: splits a sweep into jobs of `roomradar farm`, one per setting and scene, and merges their
// results.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/evaluation/pareto/sweep.hpp"

namespace roomradar {

/// Returns a job's name: the work, the scene's index, and a digit (0-9, a-z) per parameter, such as
/// "prescan-0-4214".
std::string sweep_job_name(const MeasuredWork& work, std::size_t scene, const Setting& setting);

/// Returns the names of the jobs that measure the settings in all scenes.
std::vector<std::string> sweep_job_names(const MeasuredWork& work, const std::vector<Setting>& settings);

/// Returns the manifest's lines for these jobs: `trade --only WORK --setting SETTING WORDS --rows
/// {}/rows.json`, where WORDS is what `words_of` returns for a scene.
std::string sweep_manifest(const MeasuredWork& work, const std::vector<Setting>& settings,
                           const std::function<std::string(std::size_t scene)>& words_of);

/// Writes the rows of a sweep with a single setting in a single scene. Throws Error if the file cannot be
/// written.
void write_sweep_rows(const MeasuredWork& work, const std::vector<SweepRow>& rows,
                      const std::filesystem::path& path);

/// Returns the rows of all jobs, by scene, setting and repetition. A job without results has rows with its
/// fault.
/// @param folder  folder of the jobs' results
/// @param faults  by name of job: why the job has no results
/// @throws Error if a file is damaged
std::vector<SweepRow> joined_sweep_rows(const MeasuredWork& work, const std::vector<Setting>& settings,
                                        int repeats, const std::filesystem::path& folder,
                                        const std::map<std::string, std::string>& faults);

}  // namespace roomradar
