// mpi_farm.hpp: runs the jobs of a plan on all ranks of an MPI program.
#pragma once
#include <filesystem>
#include <optional>

#include "app/farm/farm.hpp"

namespace roomradar {

/// Sends rank 0's plan to all ranks of MPI_COMM_WORLD. Each rank reads the manifest itself, so the same files
/// must exist under the same paths on all ranks.
/// @param plan  rank 0: the plan; null: all ranks return nullopt. Ignored on other ranks
std::optional<FarmPlan> share_plan(const FarmPlan* plan);

/// Runs the jobs of a plan, one at a time on each rank. Rank 0 assigns the jobs, and runs jobs, too. A rank
/// that waits for a job sleeps. Call on all ranks, on the thread that initialised MPI.
/// @param plan     from share_plan()
/// @param program  path of the executable that the jobs run
/// @param watch    called on rank 0 only
/// @return rank 0: the final state; undefined on other ranks
FarmState run_farm_on_ranks(const FarmPlan& plan, const std::filesystem::path& program,
                            const WatchFarm& watch = {});

}  // namespace roomradar
