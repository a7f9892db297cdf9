// checkpoint_folder.cpp: numbered folders, each with a manifest of its files' sizes and checksums.
#include "mapping/storage/checkpoint_folder.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <system_error>

#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folder_entries.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kWork = "work.json";
constexpr const char* kWorkWriting = "work.json.writing";
constexpr const char* kWriting = "checkpoint.writing";
constexpr const char* kManifest = "manifest.json";
constexpr std::string_view kPrefix = "checkpoint-";
constexpr std::int64_t kKept = 2;
constexpr std::uintmax_t kMaxJsonBytes = 16U << 20U;

[[noreturn]] void reject(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

fs::path numbered(const fs::path& folder, std::int64_t number) {
  return folder / (std::string(kPrefix) + std::to_string(number));
}

Json read_json(const fs::path& path) {
  std::error_code fault;
  if (fs::is_symlink(path, fault)) reject(path, "is a link; checkpoints contain no links");
  Json json = Json::parse(read_bytes(path, "a checkpoint's description", kMaxJsonBytes), nullptr,
                          /*allow_exceptions=*/false);
  if (json.is_discarded() || !json.is_object())
    reject(path,
           "is damaged" + std::string(path.filename() == kWork ? "; delete the folder to start again" : ""));
  return json;
}

/// Returns sorted paths relative to the folder, without litter of desktops.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator each(folder); each != fs::end(each); ++each) {
    if (is_litter(each->path().filename().string()))
      each.disable_recursion_pending();
    else if (!each->is_directory())
      files.push_back(each->path().lexically_relative(folder));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Returns a file's size and checksum. For a file linked from the previous checkpoint, reuses the old entry
/// instead of reading it.
Json description_of(const fs::path& into, const fs::path& file, const fs::path& previous,
                    const Json& before) {
  const auto was = before.find(file.generic_string());
  std::error_code fault;
  if (was != before.end() && fs::equivalent(previous / file, into / file, fault)) return *was;
  return {{"bytes", fs::file_size(into / file)}, {"sha256", sha256_of_file(into / file)}};
}

/// Waits until all subfolders, and all files written since `since`, are on disk.
void sync_new_files(const fs::path& folder, fs::file_time_type since) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory() || entry.last_write_time() >= since) sync_to_disk(entry.path());
}

}  // namespace

void write_checkpoint(const fs::path& folder, std::int64_t number, std::int64_t last_number,
                      const std::string& stage, const WriteCheckpointFiles& write_files,
                      fs::file_time_type on_disk_until) {
  const fs::path into = folder / kWriting;
  fs::remove_all(into);
  fs::create_directory(into);
  const fs::path previous = last_number > 0 ? numbered(folder, last_number) : fs::path{};
  const Json before = previous.empty() ? Json::object() : read_json(previous / kManifest).at("files");
  write_files(into, previous);
  Json manifest{{"stage", stage}, {"files", Json::object()}};
  for (const fs::path& file : files_below(into))
    manifest["files"][file.generic_string()] = description_of(into, file, previous, before);
  write_bytes(into / kManifest, manifest.dump(1) + "\n");
  sync_new_files(folder, on_disk_until);
  fs::remove_all(numbered(folder, number));  // damaged, or from an earlier numbering
  fs::rename(into, numbered(folder, number));
  sync_to_disk(folder);
  for (const std::int64_t other : checkpoint_numbers(folder)) {
    if (other <= number - kKept || other > number) fs::remove_all(numbered(folder, other));
  }
}

void discard_unfinished(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder / kWriting, ignored);
}

Checkpoint read_checkpoint(const fs::path& all, std::int64_t number) {
  const fs::path folder = numbered(all, number);
  const Json manifest = read_json(folder / kManifest);
  const auto stage = manifest.find("stage");
  const auto files = manifest.find("files");
  if (stage == manifest.end() || !stage->is_string() || files == manifest.end() || !files->is_object())
    reject(folder / kManifest, "is damaged");
  std::size_t listed = 1;  // the manifest itself
  for (const auto& [name, expected] : files->items()) {
    const fs::path path = folder / name;
    const fs::path inside = fs::path(name).lexically_normal();
    if (inside.is_absolute() || inside.empty() || *inside.begin() == "..")
      reject(folder / kManifest, "is damaged: it names a file outside its folder");
    std::error_code fault;
    if (!fs::is_regular_file(fs::symlink_status(path, fault))) reject(path, "is missing");
    const bool sound = expected.is_object() && expected.value("bytes", Json{}).is_number_unsigned() &&
                       expected.value("sha256", Json{}).is_string() &&
                       fs::file_size(path) == expected["bytes"].get<std::uintmax_t>() &&
                       sha256_of_file(path) == expected["sha256"].get<std::string>();
    if (!sound) reject(path, "is damaged");
    ++listed;
  }
  if (files_below(folder).size() != listed) reject(folder, "holds files that are not its own");
  return {stage->get<std::string>(), folder};
}

void remove_checkpoint(const fs::path& folder, std::int64_t number) {
  std::error_code ignored;
  fs::remove_all(numbered(folder, number), ignored);
}

std::vector<std::int64_t> checkpoint_numbers(const fs::path& folder) {
  std::vector<std::int64_t> numbers;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    std::int64_t number = 0;
    if (!name.starts_with(kPrefix)) continue;
    const char* const end = name.data() + name.size();
    const auto parsed = std::from_chars(name.data() + kPrefix.size(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number > 0) numbers.push_back(number);
  }
  std::sort(numbers.rbegin(), numbers.rend());
  return numbers;
}

void write_identity(const fs::path& folder, const std::map<std::string, std::string>& identity) {
  if (fs::exists(folder / kWork)) return;
  write_bytes(folder / kWorkWriting, Json{{"work", identity}}.dump(2) + "\n");
  fs::rename(folder / kWorkWriting, folder / kWork);
  sync_to_disk(folder / kWork);
}

bool has_nothing_to_resume(const fs::path& folder) {
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (name != kWork && name != kCheckpointLock && !is_litter(name)) return false;
  }
  return !fault;
}

fs::path done_beside(const fs::path& folder) { return folder.string() + ".done"; }

void require_checkpoints_only(const fs::path& folder, std::string_view beside) {
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(folder, fault);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    reject(folder, "is not a folder, but has the name of the scan's checkpoint folder; move it away");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (name != kWork && name != kWorkWriting && name != kCheckpointLock && name != kWriting &&
        name != beside && !name.starts_with(kPrefix) && !is_litter(name))
      reject(folder, "holds \"" + name + "\", which is not part of an interrupted scan; move it away");
  }
  if (fault) reject(folder, "cannot be listed: " + system_reason(fault));
}

std::map<std::string, std::string> identity_of(const fs::path& folder) {
  const Json json = read_json(folder / kWork);
  const auto work = json.find("work");
  const char* const kDamaged = "is damaged; delete the folder to start again";
  if (work == json.end() || !work->is_object()) reject(folder / kWork, kDamaged);
  std::map<std::string, std::string> identity;
  for (const auto& [name, value] : work->items()) {
    if (!value.is_string()) reject(folder / kWork, kDamaged);
    identity[name] = value.get<std::string>();
  }
  return identity;
}

bool carry_over(const fs::path& from, const fs::path& to) {
  std::error_code fault;
  if (!fs::is_regular_file(from, fault)) return false;
  fs::create_hard_link(from, to, fault);
  if (!fault) return true;
  return fs::copy_file(from, to, fault) && !fault;
}

}  // namespace roomradar
