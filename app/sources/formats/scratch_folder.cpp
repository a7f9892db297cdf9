// temporary_folder.cpp: mkdtemp with error messages.
#include "app/sources/formats/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "mapping/types/system/error.hpp"

namespace roomradar {

std::filesystem::path make_temporary_folder(std::filesystem::path parent) {
  std::error_code fault;
  if (parent.empty()) parent = std::filesystem::temp_directory_path(fault);
  if (fault) throw Error("there is no folder for temporary files; set TMPDIR to one: " + fault.message());
  std::string pattern = (parent / "roomradar-XXXXXX").string();
  if (!mkdtemp(pattern.data()))
    throw Error(parent.string() + ": no temporary folder can be made there: " + std::strerror(errno));
  return pattern;
}

}  // namespace roomradar
