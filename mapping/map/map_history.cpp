// map_history.cpp: earlier revisions of a map: opened, restored, pruned.
#include "mapping/map/map_history.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include "mapping/map/map_files.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

std::optional<RevisionName> revision_name(const fs::path& name) {
  const std::string text = name.string();
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0 || at + 1 == text.size()) return std::nullopt;
  RevisionName found{text.substr(0, at), 0};
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + at + 1, end, found.revision);
  if (parsed.ec != std::errc() || parsed.ptr != end || found.revision < 1) return std::nullopt;
  return found;
}

fs::path make_temporary_folder() {
  std::string name = (fs::temp_directory_path() / "roomradar-revision-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw Error(name + ": cannot be created: " + system_reason(errno) + "; set TMPDIR to another folder");
  return name;
}

}  // namespace

RevisionFiles revision_files(const fs::path& folder, const MapInfo& info) {
  RevisionFiles files;
  for (const auto& [name, file] : info.files) files[name] = {file.bytes, file.sha256, ""};
  const fs::path described = folder / kMapInfoFile;
  files[kMapInfoFile] = {fs::file_size(described), sha256_of_file(described), ""};
  return files;
}

std::vector<Visit> map_visits(const fs::path& folder) {
  std::vector<Visit> visits = read_visits(folder);
  if (visits.empty()) visits.push_back({1, "", {"an earlier version", load_map_info(folder).source, {}}, {}});
  return visits;
}

RevisionName parse_revision_name(const fs::path& name) {
  if (std::optional<RevisionName> found = revision_name(name)) return *found;
  throw Error(name.string() + ": names no revision; give the map's folder, @ and a number, such as " +
              (name.string().find('@') == std::string::npos ? name.string() : "maps/kitchen") + "@2");
}

OpenedMap::OpenedMap(const fs::path& name) : folder_(name) {
  std::error_code ignored;
  if (fs::exists(name, ignored)) return;
  const std::optional<RevisionName> named = revision_name(name);
  if (!named || !fs::exists(named->folder / kMapInfoFile, ignored))
    return;  // the caller says what is missing
  const MapInfo info = load_map_info(named->folder);
  const std::vector<Visit> visits = map_visits(named->folder);
  if (visits.back().revision == named->revision) {
    folder_ = named->folder;
    return;
  }
  temporary_ = make_temporary_folder();
  folder_ = temporary_ / name.filename();
  try {
    make_folder(folder_);
    extract_revision(named->folder, revision_files(named->folder, info), named->revision, folder_);
  } catch (...) {
    fs::remove_all(temporary_, ignored);
    throw;
  }
}

OpenedMap::~OpenedMap() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

Visit restore_revision(const fs::path& folder, int revision) {
  const fs::path target = tidy_map_name(folder);
  const VisitsLock lock(target);
  const MapInfo info = load_map_info(target);
  const RevisionFiles files = revision_files(target, info);
  AtomicFolder restored(target);
  extract_revision(target, files, revision, restored.path());
  carry_objects(target / kMapObjectsFolder, restored.path());
  const MapInfo restored_info = load_map_info(restored.path());
  Visit made = record_visit(target, files, restored.path(), revision_files(restored.path(), restored_info),
                            {"restored revision " + std::to_string(revision), "", {}});
  restored.commit();
  return made;
}

Visit undo_last_visit(const fs::path& folder) {
  const std::vector<Visit> visits = map_visits(folder);
  const MapInfo info = load_map_info(folder);
  // Restored files say of which revision they are, and from which that was made.
  const int before = info.parent_revision;
  const bool is_kept =
      std::any_of(visits.begin(), visits.end(), [&](const Visit& visit) { return visit.revision == before; });
  if (before < 1) throw Error(folder.string() + ": has nothing to undo: it is as it was first saved");
  if (!is_kept)
    throw Error(folder.string() + ": cannot be undone further: revision " + std::to_string(before) +
                " was pruned");
  return restore_revision(folder, before);
}

int prune_map(const fs::path& folder, int keep) {
  return prune_visits(folder, revision_files(folder, load_map_info(folder)), keep);
}

void carry_objects(const fs::path& from, const fs::path& map) {
  std::error_code fault;
  if (from.empty() || !fs::is_directory(from, fault)) return;
  const fs::path to = map / kMapObjectsFolder;
  make_folder(to);
  for (const fs::directory_entry& entry : fs::directory_iterator(from, fault)) {
    if (!entry.is_regular_file(fault)) continue;
    const fs::path copy = to / entry.path().filename();
    fs::create_hard_link(entry.path(), copy, fault);  // files there are replaced, never changed
    if (!fault) continue;
    fault.clear();
    fs::copy_file(entry.path(), copy, fault);
    if (fault) throw Error(entry.path().string() + ": cannot be copied: " + system_reason(fault));
    sync_to_disk(copy);
  }
  if (fault) throw Error(from.string() + ": cannot be listed: " + system_reason(fault));
  sync_to_disk(to);
}

}  // namespace roomradar
