// main.cpp: roomradar: scans, augmented reality, maps of rooms. Other commands: programs/.
#include "app/commands/command_line.hpp"
#include "app/commands/commands.hpp"

int main(int argc, char** argv) {
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
                      .simulate = run});
}
