// folders.cpp: names the nearest existing folder as the cause of a failure; the names of litter, and lists
// without it.
#include "mapping/types/system/folders.hpp"

#include <algorithm>
#include <array>
#include <system_error>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 32> kLitter = {
    // macOS
    ".DS_Store", "__MACOSX", ".AppleDouble", ".AppleDB", ".AppleDesktop", ".LSOverride", ".Spotlight-V100",
    ".fseventsd", ".TemporaryItems", ".DocumentRevisions-V100", ".VolumeIcon.icns", ".apdisk", ".localized",
    ".com.apple.timemachine.donotpresent", "Network Trash Folder", "Temporary Items", "Icon\r",
    // KDE, GNOME and file systems of Linux
    ".directory", ".hidden", "lost+found",
    // Windows
    "Thumbs.db", "thumbs.db", "ehthumbs.db", "ehthumbs_vista.db", "Desktop.ini", "desktop.ini",
    "$RECYCLE.BIN", "System Volume Information",
    // network shares and synchronised folders
    "@eaDir", ".stfolder", ".sync", ".dropbox.attr"};
/// AppleDouble, trash, files deleted while open on NFS and FUSE, locks of LibreOffice.
constexpr std::array<std::string_view, 5> kLitterBegins = {"._", ".Trash", ".nfs", ".fuse_hidden", ".~lock."};

}  // namespace

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

bool is_litter(std::string_view name) {
  return std::find(kLitter.begin(), kLitter.end(), name) != kLitter.end() ||
         std::any_of(kLitterBegins.begin(), kLitterBegins.end(),
                     [name](std::string_view begin) { return name.starts_with(begin); });
}

bool is_hidden_file(std::string_view name) { return name.starts_with('.') || is_litter(name); }

std::vector<fs::path> entries_of(const fs::path& folder, std::error_code& fault) {
  std::vector<fs::path> paths;
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end; each.increment(fault))
    if (!is_hidden_file(each->path().filename().string())) paths.push_back(each->path());
  std::sort(paths.begin(), paths.end(),
            [](const fs::path& a, const fs::path& b) { return a.native() < b.native(); });
  return paths;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::error_code fault;
  std::vector<fs::path> paths = entries_of(folder, fault);
  if (fault) throw fs::filesystem_error("cannot be listed", folder, fault);
  return paths;
}

bool is_empty_folder(const fs::path& folder, std::error_code& fault) {
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end; each.increment(fault))
    if (!is_litter(each->path().filename().string())) return false;
  return !fault;
}

}  // namespace roomradar
