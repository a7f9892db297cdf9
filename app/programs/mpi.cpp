// mpi.cpp: roomradar-mpi: runs the jobs of `roomradar farm` and `roomradar building` on all ranks of an
// MPI program.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <optional>

#include "app/building/building_command.hpp"
#include "app/cli/program_beside.hpp"
#include "app/commands/farm_command.hpp"
#include "app/farm/mpi_farm.hpp"
#include "mapping/types/system/version.hpp"

namespace {

using namespace roomradar;

/// Programs that do the jobs.
constexpr const char* kFarmJobs = "roomradar";
constexpr const char* kBuildingJobs = "roomradar-building";

/// Executes `farm` on this rank. Returns the exit status.
int run_on_rank(const FarmOptions& options, int rank) {
  std::optional<FarmPlan> plan;
  std::exception_ptr fault;
  if (rank == 0) try {
      (void)program_beside(kFarmJobs);
      plan = plan_of(options);
    } catch (const std::exception&) {
      fault = std::current_exception();
    }
  plan = share_plan(plan ? &*plan : nullptr);
  if (fault) std::rethrow_exception(fault);
  if (!plan) return 0;  // rank 0 says why
  const auto run_jobs = [&](const WatchFarm& watch) {
    return run_farm_on_ranks(*plan, program_beside(kFarmJobs), watch);
  };
  if (rank == 0) return exit_status(run_planned(options, *plan, run_jobs));
  (void)run_jobs({});
  return 0;
}

/// Executes `building` on this rank: rank 0 decides, all do the jobs of each stage. Returns the exit status.
int run_on_rank(const BuildingOptions& options, int rank) {
  if (rank != 0) {
    while (const std::optional<FarmPlan> plan = share_plan(nullptr))
      (void)run_farm_on_ranks(*plan, program_beside(kBuildingJobs));
    return 0;
  }
  int status = 1;
  std::exception_ptr fault;
  try {
    (void)program_beside(kBuildingJobs);
    status = run_building(options, [](const std::string& /*stage*/, const FarmPlan& plan) {
      return run_farm_on_ranks(*share_plan(&plan), program_beside(kBuildingJobs));
    });
  } catch (const std::exception&) {
    fault = std::current_exception();
  }
  (void)share_plan(nullptr);  // the end
  if (fault) std::rethrow_exception(fault);
  return status;
}

int run_command_line(int argc, char** argv, int rank) {
  CLI::App app(
      "roomradar-mpi: the jobs of `roomradar farm` or `roomradar building` on the ranks of an MPI\n"
      "program, for example\n"
      "  mpirun -n 8 roomradar-mpi farm rooms.txt --out results\n"
      "  srun roomradar-mpi building office --recordings office.txt\n"
      "Exit status: 0 done, 1 a job failed, 2 wrong usage.",
      "roomradar-mpi");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  CLI::App& farm = *app.add_subcommand("farm", "run a list of commands as jobs; see `roomradar help farm`");
  FarmOptions options;
  add_options(farm, options);
  CLI::App& building =
      *app.add_subcommand("building", "make one map of a building; see `roomradar help building`");
  BuildingOptions building_options;
  add_options(building, building_options);
  try {
    app.parse(argc, argv);
    if (options.processes > 0 || building_options.processes > 0)
      throw CLI::ValidationError("--processes: the number of jobs at a time is that of the ranks");
    if (options.emit) throw CLI::ValidationError("--emit: use `roomradar farm --emit`");
  } catch (const CLI::ParseError& error) {
    const bool is_wrong = error.get_exit_code() != 0;
    if (rank == 0) app.exit(error);
    return is_wrong ? 2 : 0;
  }
  return building.parsed() ? run_on_rank(building_options, rank) : run_on_rank(options, rank);
}

}  // namespace

int main(int argc, char** argv) {
  int provided = 0, rank = 0, status = 1;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    status = run_command_line(argc, argv, rank);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roomradar-mpi: %s\n", error.what());
  }
  // mpirun kills all ranks as soon as one ends with another status than 0, so all wait for each other.
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Finalize();
  return status;
}
