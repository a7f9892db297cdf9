// fallthrough.cpp: roomradar-fallthrough: `roomradar fallthrough`.
#include "app/commands/command_line.hpp"
#include "app/commands/commands.hpp"

int main(int argc, char** argv) {
  using namespace roomradar;
  return run_program(argc, argv, {.fallthrough = run});
}
