// map_places.cpp: lists, copies, moves and deletes the folders of maps.
#include "mapping/map/map_places.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <set>
#include <system_error>

#include "mapping/map/map_files.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBuildingInfoFile = "building.json";
constexpr const char* kTrashInfoExtension = ".trashinfo";

[[noreturn]] void fail_place(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

bool holds(const fs::path& folder, const char* name) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(folder / name, ignored));
}

// Listing.

std::time_t written_at(const fs::path& file) {
  std::error_code fault;
  const fs::file_time_type at = fs::last_write_time(file, fault);
  if (fault) return 0;
  return std::chrono::system_clock::to_time_t(
      std::chrono::time_point_cast<std::chrono::system_clock::duration>(std::chrono::file_clock::to_sys(at)));
}

/// Returns the total size of all files that can be read.
std::uintmax_t bytes_in(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  std::error_code fault;
  for (fs::recursive_directory_iterator each(folder, fs::directory_options::skip_permission_denied, fault),
       end;
       !fault && each != end; each.increment(fault)) {
    std::error_code gone;
    if (!fs::is_regular_file(each->symlink_status(gone))) continue;
    const std::uintmax_t size = each->file_size(gone);
    if (!gone) bytes += size;
  }
  return bytes;
}

/// Throws Error naming the first file whose size is not the one in map.json.
void require_sizes(const fs::path& folder, const MapInfo& info) {
  for (const auto& [name, expected] : info.files) {
    std::error_code fault;
    const fs::path path = folder / name;
    if (!fs::is_regular_file(fs::symlink_status(path, fault))) fail_place(path, "is missing");
    if (fs::file_size(path, fault) != expected.bytes)
      fail_place(path, "has not the size that " + std::string(kMapInfoFile) +
                           " states; it was altered or cut short");
  }
}

MapPlace describe_place(const fs::path& folder) {
  MapPlace place{.folder = folder, .is_building = !holds(folder, kMapInfoFile), .bytes = bytes_in(folder)};
  place.saved_at = written_at(folder / (place.is_building ? kBuildingInfoFile : kMapInfoFile));
  if (place.is_building) return place;
  try {
    const MapInfo info = load_map_info(folder);
    place.triangles = info.triangles;
    place.source = info.source;
    require_sizes(folder, info);
  } catch (const std::exception& error) {
    place.fault = error.what();
  }
  return place;
}

// Contents.

/// Returns what changes when the file is replaced or written. Empty if it is not there any more.
std::string version_of(const fs::path& file) {
  struct stat facts {};
  if (::lstat(file.c_str(), &facts) != 0) return {};
  return std::to_string(facts.st_ino) + " " + std::to_string(facts.st_size) + " " +
         std::to_string(facts.st_mtim.tv_sec) + " " + std::to_string(facts.st_mtim.tv_nsec);
}

void add_contents(const fs::path& folder, const std::string& prefix, std::vector<MapContent>& contents) {
  std::error_code fault;
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end; each.increment(fault)) {
    const std::string name = each->path().filename().string();
    if (is_litter(name) || is_transient(name)) continue;
    std::error_code unknown;
    const fs::file_status status = each->symlink_status(unknown);
    if (status.type() == fs::file_type::not_found) continue;  // deleted at this moment
    if (fs::is_directory(status)) {
      add_contents(each->path(), prefix + name + "/", contents);
    } else if (fs::is_regular_file(status)) {
      std::error_code gone;
      const std::uintmax_t bytes = each->file_size(gone);
      const std::string version = version_of(each->path());
      if (!gone && !version.empty()) contents.push_back({prefix + name, bytes, version});
    } else {
      fail_place(each->path(),
                 "is neither a file nor a folder; a map contains only these, so remove it first");
    }
  }
  if (fault && fault != std::errc::no_such_file_or_directory)
    fail_place(folder, "cannot be listed: " + system_reason(fault));
}

// Checks.

/// Returns the path without "." and ".." components and without trailing slash.
fs::path tidy_existing(const fs::path& folder) {
  fs::path path = folder.lexically_normal();
  if (!path.empty() && !path.has_filename()) path = path.parent_path();  // a trailing slash
  std::error_code fault;
  if (path.filename() == "." || path.filename() == "..") path = fs::canonical(path, fault);
  return path;
}

/// Returns the path with all links resolved as far as it exists.
fs::path whole_path(const fs::path& path) {
  std::error_code fault;
  const fs::path whole = fs::weakly_canonical(fs::absolute(path), fault);
  return fault ? fs::absolute(path) : whole;
}

bool is_within(const fs::path& path, const fs::path& folder) {
  const fs::path inner = whole_path(path), outer = whole_path(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// Throws Error if a killed save left the map of this place beside it. That of `from` may be brought back.
void require_no_interrupted(const fs::path& target, const fs::path& from) {
  const fs::path aside = interrupted_replacement_of(target);
  if (!aside.empty() && (from.empty() || whole_path(aside) != whole_path(from)))
    fail_place(target, "a save was killed while it took this map's place, and left the map as " +
                           aside.string() +
                           "; bring it back with `roomradar map rename`, or choose another name");
}

fs::path free_place(const fs::path& folder, const fs::path& from) {
  fs::path target = tidy_map_name(folder);
  require_outside_maps(target);
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(target, ignored)))
    fail_place(folder, "exists already; choose another name, or rename or delete what is there");
  require_no_interrupted(target, from);
  return target;
}

/// Returns place_for_map(to). Also throws if that lies in the folder `from`. The place may be that from which
/// a killed save moved `from` aside.
fs::path place_outside(const fs::path& to, const fs::path& from) {
  fs::path target = free_place(to, from);
  require_outside_map(target, from);
  return target;
}

// Copying.

/// Copies one file. Does nothing if it is not there any more.
void copy_one(const fs::path& from, const fs::path& to) {
  if (to.has_parent_path()) make_folder(to.parent_path());
  std::error_code fault, ignored;
  fs::remove(to, ignored);
  const fs::file_time_type written = fs::last_write_time(from, fault);
  if (!fault) fs::copy_file(from, to, fault);
  if (fault == std::errc::no_such_file_or_directory && !fs::exists(from, ignored)) return;
  if (fault) fail_place(to, "cannot be copied from " + from.string() + ": " + system_reason(fault));
  fs::last_write_time(to, written, ignored);
  sync_to_disk(to);
}

void copy_changes(const fs::path& from, const std::vector<MapContent>& contents, const fs::path& to,
                  const std::vector<MapContent>& copied) {
  std::set<std::string> names;
  for (const MapContent& content : contents) {
    names.insert(content.name);
    if (std::find(copied.begin(), copied.end(), content) == copied.end())
      copy_one(from / content.name, to / content.name);
  }
  std::error_code ignored;
  for (const MapContent& content : copied)
    if (!names.contains(content.name)) fs::remove(to / content.name, ignored);
}

/// Copies the files of a map until none has changed since it was copied.
void copy_contents(const fs::path& from, const fs::path& to) {
  constexpr int kAttempts = 100;
  std::vector<MapContent> copied;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::vector<MapContent> contents = contents_of_map(from);
    if (contents.empty()) fail_place(from, "was removed by another process while it was copied");
    if (contents == copied) {
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(to))
        if (entry.is_directory()) sync_to_disk(entry.path());
      return;
    }
    copy_changes(from, contents, to, copied);
    copied = std::move(contents);
  }
  fail_replaced_too_often(from);
}

// The trash of the desktop: https://specifications.freedesktop.org/trash-spec

fs::path trash_folder() {
  if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && data[0] == '/')
    return fs::path(data) / "Trash";
  const char* home = std::getenv("HOME");
  if (home == nullptr || home[0] != '/') {
    const passwd* user = getpwuid(getuid());
    home = user == nullptr ? nullptr : user->pw_dir;
  }
  if (home == nullptr || home[0] != '/')
    throw Error("there is no trash, since the home folder is not known: set HOME, or delete with --for-good");
  return fs::path(home) / ".local/share/Trash";
}

void make_private_folder(const fs::path& folder) {
  std::error_code ignored;
  if (fs::is_directory(folder, ignored)) return;
  make_folder(folder);
  fs::permissions(folder, fs::perms::owner_all, ignored);
}

std::string percent_encoded(const std::string& path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~/";
  std::string text;
  for (const char c : path) {
    if (kPlain.find(c) != std::string_view::npos) {
      text += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    text += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return text;
}

std::string trash_info_of(const fs::path& original) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  char date[40] = "";
  if (localtime_r(&now, &local) != nullptr) std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &local);
  return "[Trash Info]\nPath=" + percent_encoded(original.string()) + "\nDeletionDate=" + date + "\n";
}

/// Writes a file. Returns false if something of that name exists.
bool write_new_file(const fs::path& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) {
    if (errno == EEXIST) return false;
    fail_place(path, "cannot be written: " + system_reason(errno));
  }
  const ssize_t written = ::write(file, text.data(), text.size());
  const int reason = written < 0 ? errno : ENOSPC;
  if (::close(file) == 0 && written == static_cast<ssize_t>(text.size())) return true;
  ::unlink(path.c_str());
  fail_place(path, "cannot be written: " + system_reason(reason));
}

/// Removes what the trash notes about a folder that has left it; does nothing for other folders.
void forget_trashed(const fs::path& folder) {
  const fs::path place = fs::absolute(folder);
  if (place.parent_path().filename() != "files") return;
  std::error_code ignored;
  fs::remove(place.parent_path().parent_path() / "info" / (place.filename().string() + kTrashInfoExtension),
             ignored);
}

/// Moves a map to a place that was checked.
void move_to(const fs::path& from, const fs::path& target) {
  make_folder(target.has_parent_path() ? target.parent_path() : fs::path("."));
  if (move_to_free_place(from, target)) return;
  copy_map(from, target);  // to another file system
  remove_whole_folder(from);
}

}  // namespace

std::vector<MapPlace> map_places_in(const fs::path& folder) {
  if (holds(folder, kMapInfoFile) || holds(folder, kBuildingInfoFile))
    fail_place(folder, "is a map itself; give the folder that holds maps");
  std::error_code fault;
  if (!fs::is_directory(folder, fault))
    fail_place(folder, "there is no such folder; give one that holds maps");
  std::vector<MapPlace> places;
  for (const fs::path& path : entries_of(folder, fault))
    if (!is_transient(path.filename().string()) &&
        (holds(path, kMapInfoFile) || holds(path, kBuildingInfoFile)))
      places.push_back(describe_place(path));
  if (fault) fail_place(folder, "cannot be listed: " + system_reason(fault));
  return places;
}

std::vector<MapContent> contents_of_map(const fs::path& folder) {
  std::vector<MapContent> contents;
  add_contents(folder, "", contents);
  std::sort(contents.begin(), contents.end(),
            [](const MapContent& a, const MapContent& b) { return a.name < b.name; });
  return contents;
}

fs::path existing_map(const fs::path& folder) {
  const fs::path path = tidy_existing(folder);
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(path, fault);
  if (path.empty() || !fs::exists(status))
    fail_place(folder, "there is no such map folder; `roomradar map list` lists those that there are");
  if (fs::is_symlink(status)) fail_place(folder, "is a link; give the folder of the map itself");
  if (!fs::is_directory(status)) fail_place(folder, "is not a folder; a map is a folder, give that");
  if (holds(path, kMapInfoFile)) return path;
  if (holds(path, kBuildingInfoFile))
    fail_place(folder,
               "is the map of a building; this takes the map of one room, made with `roomradar prescan`");
  fail_place(folder, std::string("has no ") + kMapInfoFile + ", so it is not a map");
}

fs::path place_for_map(const fs::path& folder) { return free_place(folder, {}); }

void require_only_map(const fs::path& folder) {
  std::error_code fault;
  for (fs::directory_iterator each(folder, fault), end; !fault && each != end; each.increment(fault)) {
    const std::string name = each->path().filename().string();
    if (!is_map_entry(name) && !is_litter(name) && !is_transient(name))
      fail_place(folder, "holds \"" + name + "\", which is not part of a map; move that elsewhere first");
  }
  if (fault) fail_place(folder, "cannot be listed: " + system_reason(fault));
}

void require_outside_map(const fs::path& path, const fs::path& map) {
  if (is_within(path, map)) fail_place(path, "lies in the map " + map.string() + "; choose another place");
}

void copy_map(const fs::path& map, const fs::path& to) {
  const fs::path from = existing_map(map);
  AtomicFolder copy(place_outside(to, from));
  copy_contents(from, copy.path());
  copy.commit_as_new();
}

void move_map(const fs::path& map, const fs::path& to) {
  const fs::path from = existing_map(map);
  move_to(from, place_outside(to, from));
  forget_trashed(from);
}

fs::path move_map_to_trash(const fs::path& map) {
  constexpr int kNames = 10000;
  const fs::path from = existing_map(map);
  require_only_map(from);
  const fs::path trash = trash_folder();
  if (is_within(from, trash)) fail_place(map, "lies in the trash already; --for-good deletes it");
  for (const char* part : {"files", "info"}) make_private_folder(trash / part);
  const fs::path original = whole_path(from);
  for (int number = 1; number <= kNames; ++number) {
    const std::string name = original.filename().string() + (number == 1 ? "" : "-" + std::to_string(number));
    const fs::path place = trash / "files" / name;
    const fs::path note = trash / "info" / (name + kTrashInfoExtension);
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(place, ignored)) || !write_new_file(note, trash_info_of(original)))
      continue;
    try {
      move_to(from, place_outside(place, from));
    } catch (...) {
      if (!holds(place, kMapInfoFile)) fs::remove(note, ignored);
      throw;
    }
    return place;
  }
  fail_place(trash, "has too many maps of the name " + original.filename().string() + "; empty it");
}

void erase_map(const fs::path& map) {
  const fs::path from = existing_map(map);
  require_only_map(from);
  remove_whole_folder(from);
  forget_trashed(from);
}

}  // namespace roomradar
