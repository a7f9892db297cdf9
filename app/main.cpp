// main.cpp: runs the command and reports errors.
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "app/commands/command_line.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit causes a write error instead of a kill
  try {
    const roomradar::ParsedCommand command = roomradar::parse_command_line(argc, argv);
    const int status = command.work ? command.work() : command.exit_status;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout.flush())
      throw roomradar::Error("stdout: the output could not be written completely; is the disk full?");
    return status;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "roomradar: memory ran out; close other programs, or use coarser cells or smaller images\n");
    return 1;
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "roomradar: %s: cannot be used: %s\n", error.path1().c_str(),
                 roomradar::system_reason(error.code()).c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roomradar: %s\n", error.what());
    return 1;
  }
}
