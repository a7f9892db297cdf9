// batch_script.hpp: scripts that run a plan's jobs by other programs.
#pragma once
#include <filesystem>
#include <string>

#include "app/farm/farm_plan.hpp"

namespace roomradar {

enum class BatchForm {
  kMake,      ///< a makefile
  kParallel,  ///< a bash script that calls GNU parallel
  kSlurm,     ///< a bash script that submits arrays of jobs to Slurm
};

/// Returns a script that runs the jobs that are not present, each by `roomradar farm MANIFEST --out DIR --job
/// NAME`, after the jobs that it needs. For Slurm, also writes the lists of names that the script reads to
/// the results' folder. The script calls $ROOMRADAR if that is set, otherwise `program`.
/// @throws Error if a list cannot be written
std::string batch_script(const FarmPlan& plan, BatchForm form, const std::filesystem::path& program);

}  // namespace roomradar
