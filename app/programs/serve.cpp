// serve.cpp: roomradar-serve: `roomradar serve`.
#include "app/commands/command_line.hpp"
#include "app/serve/serve_command.hpp"

int main(int argc, char** argv) {
  using namespace roomradar;
  return run_program(argc, argv, {.serve = run});
}
