// farm_options.cpp: option names, help texts and checks of `roomradar farm`.
#include "app/cli/options/farm_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {

void add_options(CLI::App& command, FarmOptions& options) {
  command
      .add_option("MANIFEST", options.manifest,
                  "list of jobs, one per line: NAME: COMMAND ..., where {} is the job's own folder and\n"
                  "{NAME} that of a job which is done before (required)")
      ->required();
  command.add_option("--out", options.out, "folder of the results, with a folder per job (required)")
      ->required()
      ->type_name("DIR");
  add_processes_option(command, options.processes);
  command
      .add_option("--job", options.jobs,
                  "run only this job, after those that it needs; may be given several times. Needed jobs\n"
                  "that failed before are not run again, unless they are given, too (default: all jobs)")
      ->type_name("NAME");
  add_choice<std::optional<BatchForm>>(
      command, "--emit", options.emit,
      {{"make", BatchForm::kMake}, {"parallel", BatchForm::kParallel}, {"slurm", BatchForm::kSlurm}},
      "print a script that runs the jobs by make, GNU parallel or Slurm (default: run them here)");
  add_report_option(command, options.report);
}

}  // namespace roomradar
