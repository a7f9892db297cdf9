// make_folder.cpp: names the nearest existing folder as the cause of a failure.
#include "mapping/types/system/make_folder.hpp"

#include <system_error>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

void make_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code fault, unused;
  fs::create_directories(folder, fault);
  if (!fault) return;
  fs::path above = folder.has_parent_path() ? folder.parent_path() : ".";
  while (!fs::exists(above, unused) && above.has_parent_path() && above != above.parent_path())
    above = above.parent_path();
  std::string reason = system_reason(fault);
  const bool is_folder = fs::is_directory(above, unused);
  if (fault == std::errc::no_such_file_or_directory && is_folder)
    reason = above.string() + " cannot hold files; choose another place";
  else if ((fault == std::errc::permission_denied || fault == std::errc::operation_not_permitted) &&
           is_folder)
    reason = above.string() + " is not writable";
  throw Error(folder.string() + ": the folder cannot be made: " + reason);
}

}  // namespace roomradar
