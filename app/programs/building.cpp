// building.cpp: roomradar-building: `roomradar building`, its jobs, and `roomradar map` of a building.
#include "app/building/building_command.hpp"
#include "app/building/building_map_commands.hpp"
#include "app/commands/command_line.hpp"

int main(int argc, char** argv) {
  using namespace roomradar;
  return run_program(argc, argv,
                     {.building = run,
                      .add_building_steps = add_building_steps,
                      .building_info = run_on_building,
                      .building_verify = run_on_building,
                      .building_export = run_on_building});
}
