// program_main.cpp: main() of a program with the commands of all programs, for tests that run it in forks of
// themselves.
#include "app/building/building_command.hpp"
#include "app/building/building_map_commands.hpp"
#include "app/commands/command_line.hpp"
#include "app/commands/commands.hpp"
#include "app/serve/serve_command.hpp"
#include "tests/support/forked_program.hpp"

int roomradar_main(int argc, char** argv) {
  using namespace roomradar;
  return run_program(argc, argv,
                     {.without_arguments = run_start_alone,
                      .start = run,
                      .prescan = run,
                      .run = run,
                      .map_info = run,
                      .map_verify = run,
                      .map_export = run,
                      .map_objects = run,
                      .map_log = run,
                      .map_restore = run,
                      .map_undo = run,
                      .map_prune = run,
                      .map_list = run,
                      .map_copy = run,
                      .map_rename = run,
                      .map_delete = run,
                      .map_pack = run,
                      .map_unpack = run,
                      .map_merge = run,
                      .map_diff = run,
                      .check = run,
                      .record = run,
                      .doctor = run_doctor,
                      .simulate = run,
                      .building = run,
                      .add_building_steps = add_building_steps,
                      .building_info = run_on_building,
                      .building_verify = run_on_building,
                      .building_export = run_on_building,
                      .calibrate = run,
                      .fallthrough = run,
                      .farm = run,
                      .serve = run,
                      .trade = run});
}
