// batch_script.hpp: writes scripts by which other programs run a plan's jobs.
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

/// Returns a script that runs the jobs that have no results. The script runs each job as `roomradar farm
/// MANIFEST --out DIR --job NAME`, after the jobs that the job needs. The script calls $ROOMRADAR if that is
/// set, otherwise `program`. For Slurm, also writes lists of job names, which the script reads, to the folder
/// of the results.
/// @throws Error if a list cannot be written
std::string batch_script(const FarmPlan& plan, BatchForm form, const std::filesystem::path& program);

}  // namespace roomradar
