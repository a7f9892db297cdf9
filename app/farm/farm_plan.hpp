// farm_plan.hpp: plans the jobs of a manifest: their keys, and whether they are done.
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
  /// SHA-256 of this program's version, the words of the command, the contents of its inputs, and the keys of
  /// the jobs that it needs. Empty: the job is not part of the plan.
  std::string key;
  double cost = 0.0;        ///< as stated, otherwise 1 plus the size of its inputs in 10^6 bytes
  bool is_present = false;  ///< its folder holds the results for this key
  /// Reason why the job is not run again: it failed with this key, and the plan has it only because a wanted
  /// job needs it. Otherwise empty.
  std::string earlier_fault = {};
};

struct FarmPlan {
  Manifest manifest;
  std::filesystem::path out;     ///< absolute; a folder per job
  std::vector<PlannedJob> jobs;  ///< in the manifest's order
};

/// Hashes the inputs, and finds the jobs that are already done.
/// @param out     folder of the results; is created
/// @param wanted  jobs to plan, with those that they need; empty: all. Needed jobs that failed before are not
///                planned again unless they are wanted, too
/// @throws Error if an input cannot be read or the folder cannot be created
FarmPlan plan_farm(Manifest manifest, const std::filesystem::path& out,
                   std::span<const std::size_t> wanted = {});

/// Returns the index of a job. Throws Error if the manifest has no such job.
std::size_t index_of(const Manifest& manifest, const std::string& name);

/// Returns the words of a job as the program gets them in the job's folder: {} is replaced by ".", {NAME} by
/// that job's folder, and the path of an input by its absolute path.
std::vector<std::string> arguments_of(const FarmPlan& plan, std::size_t job);

}  // namespace roomradar
