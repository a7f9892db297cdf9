// main.cpp: parse, do, say what went wrong.
#include <csignal>
#include <cstdio>
#include <exception>

#include "app/command_line.hpp"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error to be said, not a death
  try {
    const roomradar::ParsedCommand command = roomradar::parse_command_line(argc, argv);
    return command.work ? command.work() : command.exit_status;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roomradar: %s\n", error.what());
    return 1;
  }
}
