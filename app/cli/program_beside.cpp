// program_beside.cpp: looks in the folder of /proc/self/exe.
#include "app/cli/program_beside.hpp"

#include <unistd.h>

#include "mapping/types/system/error.hpp"

namespace roomradar {

std::filesystem::path program_beside(const std::string& name) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  if (access(program.c_str(), X_OK) != 0)
    throw Error(program.string() +
                ": is missing; this part of roomradar is a program of its own: run app/setup in the "
                "source folder, which builds it, or install it there");
  return program;
}

}  // namespace roomradar
