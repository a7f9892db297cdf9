// farm_plan.hpp: plans the jobs of a manifest: computes their keys, and finds the finished ones.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/farm/manifest.hpp"

namespace roomradar {

/// A job of a plan.
struct PlannedJob {
  /// SHA-256 over the program's version, the command's words, the contents of the job's inputs, and the keys
  /// of the jobs that it needs. Empty: the job is not part of the plan.
  std::string key;
  double cost = 0.0;        ///< as stated in the manifest, otherwise 1 plus the size of the inputs in MB
  bool is_present = false;  ///< true: its folder contains the results for this key
  /// Reason of an earlier failure with this key, if the plan contains the job only because a wanted job needs
  /// it. The job is then not run again. Otherwise empty.
  std::string earlier_fault = {};
};

struct FarmPlan {
  Manifest manifest;
  std::filesystem::path out;     ///< absolute; contains one folder per job
  std::vector<PlannedJob> jobs;  ///< in the manifest's order
};

/// Hashes the inputs, and finds the jobs that already have results.
/// @param out     folder of the results; is created
/// @param wanted  indices of the jobs to plan, together with the jobs that they need; empty: all jobs. Needed
///                jobs that failed before are only run again if they are also wanted
/// @throws Error if an input cannot be read or the folder cannot be created
FarmPlan plan_farm(Manifest manifest, const std::filesystem::path& out,
                   std::span<const std::size_t> wanted = {});

/// Returns the index of a job. Throws Error if the manifest has no such job.
std::size_t index_of(const Manifest& manifest, const std::string& name);

/// Returns a job's words as passed to the program, which runs in the job's folder. {} is replaced by ".",
/// {NAME} by the folder of the job NAME, and the path of an input by its absolute path.
std::vector<std::string> arguments_of(const FarmPlan& plan, std::size_t job);

}  // namespace roomradar
