// visits.cpp: the log of revisions, and the blocks of those that are not the latest.
//
// For each file of an earlier revision, the blocks of its plain form are either in the folder's present file
// of that name, or in the block store. So the latest revision costs nothing, and a revision only what the
// next one changed.
#include "mapping/history/visits.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>
#include <unordered_map>
#include <utility>

#include "mapping/history/block_store.hpp"
#include "mapping/history/plain_form.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kSha256_bytes = 32;
constexpr std::uintmax_t kMaxLog_bytes = 1U << 28U;

std::string hex_of(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string hex;
  for (const char c : bytes) {
    hex += kDigits[static_cast<unsigned char>(c) >> 4U];
    hex += kDigits[static_cast<unsigned char>(c) & 15U];
  }
  return hex;
}

/// Returns the bytes of an even number of hexadecimal digits; nullopt if there are others.
std::optional<std::string> bytes_of(const std::string& hex) {
  const auto value = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
  };
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    const int high = value(hex[i]), low = value(hex[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    bytes += static_cast<char>(high * 16 + low);
  }
  return hex.size() % 2 == 0 ? std::optional(bytes) : std::nullopt;
}

Json to_json(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::string line_of(const Visit& visit) {
  Json json = {{"revision", visit.revision},
               {"made_at", visit.made_at},
               {"made_by", visit.note.made_by},
               {"source", visit.note.source}};
  json["changes"] = Json::array();
  for (const VisitChange& change : visit.note.changes)
    json["changes"].push_back({{"kind", change.kind},
                               {"min_m", to_json(change.box_world.min())},
                               {"max_m", to_json(change.box_world.max())}});
  if (!visit.files.empty()) json["files"] = Json::object();
  for (const auto& [name, file] : visit.files) {
    json["files"][name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
    if (!file.root.empty()) json["files"][name]["root"] = hex_of(file.root);
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

/// Reads a line of the log. Throws nlohmann's exception, or std::invalid_argument, if it is damaged.
Visit visit_of(const std::string& line) {
  const Json json = Json::parse(line);
  Visit visit{json.at("revision").get<int>(),
              json.at("made_at").get<std::string>(),
              {json.at("made_by").get<std::string>(), json.at("source").get<std::string>(), {}},
              {}};
  for (const Json& change : json.at("changes")) {
    const auto low = change.at("min_m").get<std::array<double, 3>>();
    const auto high = change.at("max_m").get<std::array<double, 3>>();
    visit.note.changes.push_back(
        {change.at("kind").get<std::string>(),
         {Eigen::Vector3d(low[0], low[1], low[2]), Eigen::Vector3d(high[0], high[1], high[2])}});
  }
  const Json files = json.value("files", Json::object());
  for (const auto& entry : files.items()) {
    const Json& file = entry.value();
    const std::optional<std::string> root = bytes_of(file.value("root", ""));
    if (!is_plain_name(entry.key()) || !root || (!root->empty() && root->size() != kSha256_bytes))
      throw std::invalid_argument("a file");
    visit.files[entry.key()] = {file.at("bytes").get<std::uint64_t>(), file.at("sha256").get<std::string>(),
                                *root};
  }
  return visit;
}

std::string read_file(const fs::path& path) { return read_bytes(path, "a file of a map"); }

std::string text_of(const std::vector<Visit>& visits) {
  std::string text;
  for (const Visit& visit : visits) text += line_of(visit);
  return text;
}

/// Blocks of a file in its plain form. The plain form must outlive them.
struct FileBlocks {
  std::vector<std::string_view> contents;
  BlockTree tree;
};
FileBlocks blocks_of(const std::string& plain) {
  FileBlocks blocks{cut_into_blocks(plain), {}};
  blocks.tree = block_tree_of(blocks.contents);
  return blocks;
}

/// Adds to the store what is needed to restore a file when `next` has replaced it, and returns its root.
/// @param next  the file of this name that replaces it; empty: none
std::string keep_file(const fs::path& file, const fs::path& next, BlockStore& store) {
  const std::string plain = plain_form(read_file(file));
  const FileBlocks blocks = blocks_of(plain);
  std::set<std::string> in_next;
  if (!next.empty()) {
    const std::string plain_next = plain_form(read_file(next));
    const FileBlocks others = blocks_of(plain_next);
    in_next.insert(others.tree.blocks.begin(), others.tree.blocks.end());
  }
  for (std::size_t i = 0; i < blocks.contents.size(); ++i)
    if (!in_next.contains(blocks.tree.blocks[i])) store.add(blocks.contents[i]);
  for (const std::string& list : blocks.tree.lists) store.add(list);
  return store.add(blocks.tree.root);
}

/// Gives `next` the block store of `folder`: the same file if the file system can, else a copy.
void share_blocks(const fs::path& folder, const fs::path& next) {
  std::error_code fault;
  if (!fs::exists(folder / kVisitsBlocks, fault)) return;
  fs::create_hard_link(folder / kVisitsBlocks, next / kVisitsBlocks, fault);
  if (!fault) return;
  fault.clear();
  fs::copy_file(folder / kVisitsBlocks, next / kVisitsBlocks, fault);
  if (fault) throw Error((next / kVisitsBlocks).string() + ": cannot be written: " + system_reason(fault));
}

/// Calls with each checksum of a list of checksums.
void for_each_checksum(const std::string& list, const std::function<void(const std::string&)>& call) {
  for (std::size_t i = 0; i + kSha256_bytes <= list.size(); i += kSha256_bytes)
    call(list.substr(i, kSha256_bytes));
}

/// Restores files of a folder's earlier revisions.
class Restorer {
 public:
  Restorer(fs::path folder, const RevisionFiles& files)
      : folder_(std::move(folder)),
        files_(files),
        store_(folder_ / kVisitsBlocks),
        visits_(read_visits(folder_)) {}

  [[nodiscard]] const std::vector<Visit>& visits() const { return visits_; }

  [[nodiscard]] const Visit& visit(int revision) const {
    const auto found = std::find_if(visits_.begin(), visits_.end(),
                                    [&](const Visit& visit) { return visit.revision == revision; });
    if (found != visits_.end()) return *found;
    throw Error(folder_.string() + ": has no revision " + std::to_string(revision) +
                (visits_.empty() ? "; it has no earlier revisions"
                                 : ", but " + std::to_string(visits_.front().revision) + " to " +
                                       std::to_string(visits_.back().revision)));
  }

  /// Names of the files of a revision.
  [[nodiscard]] std::vector<std::string> names_of(const Visit& visit) const {
    std::vector<std::string> names;
    for (const auto& [name, file] : is_latest(visit) ? files_ : visit.files) names.push_back(name);
    return names;
  }

  /// Returns the bytes of a file of a revision.
  std::string restored(const Visit& visit, const std::string& name) {
    const auto fail = [&](const char* fault) {
      throw Error(folder_.string() + ": " + name + " of revision " + std::to_string(visit.revision) + " " +
                  fault);
    };
    for (const Visit* at = &visit; !is_latest(*at); ++at) {
      const auto file = at->files.find(name);
      if (file == at->files.end()) fail("is not in the log");
      if (file->second.root.empty()) continue;
      std::string bytes = from_plain_form(plain_of(file->second, name), (folder_ / kVisitsBlocks).string());
      if (sha256_of(bytes) != file->second.sha256)
        fail("cannot be restored bit by bit; is the zstd library another one than when it was saved?");
      return bytes;
    }
    std::string bytes = read_file(folder_ / name);
    const auto file = files_.find(name);
    if (file == files_.end() || (!file->second.sha256.empty() && sha256_of(bytes) != file->second.sha256))
      fail("was replaced while it was read; try again");
    return bytes;
  }

  /// Calls with the checksum of each block in the store that a revision uses, without its data blocks that
  /// are in present files.
  void for_each_block(const Visit& visit, const std::function<void(const std::string&)>& call) const {
    for (const auto& [name, file] : visit.files) {
      if (file.root.empty()) continue;
      call(file.root);
      for_each_checksum(store_.read(file.root), [&](const std::string& list) {
        call(list);
        for_each_checksum(store_.read(list), [&](const std::string& block) {
          if (store_.contains(block)) call(block);
        });
      });
    }
  }

  /// Throws Error unless each block of a revision is there and sound.
  /// @param[in,out] sound  blocks that were found sound before
  void require_whole(const Visit& visit, std::set<std::string>& sound) {
    const auto require = [&](const std::string& sha256) {
      if (!sound.contains(sha256)) static_cast<void>(store_.read(sha256));
      sound.insert(sha256);
    };
    for (const auto& [name, file] : visit.files) {
      if (file.root.empty()) continue;
      require(file.root);
      for_each_checksum(store_.read(file.root), [&, &name = name](const std::string& list) {
        if (sound.contains(list + name)) return;  // with all its blocks
        require(list);
        for_each_checksum(store_.read(list), [&](const std::string& block) {
          if (store_.contains(block) || !present(name).blocks.contains(block)) require(block);
        });
        sound.insert(list + name);
      });
    }
  }
  [[nodiscard]] const BlockStore& store() const { return store_; }

 private:
  /// A present file in its plain form, by the blocks' checksums.
  struct PresentFile {
    std::string plain;
    std::unordered_map<std::string, std::string_view> blocks;
  };
  fs::path folder_;
  const RevisionFiles& files_;
  BlockStore store_;
  std::vector<Visit> visits_;
  std::map<std::string, PresentFile> present_;

  [[nodiscard]] bool is_latest(const Visit& visit) const { return visit.revision == visits_.back().revision; }

  const PresentFile& present(const std::string& name) {
    const auto [at, is_new] = present_.try_emplace(name);
    if (!is_new || !files_.contains(name)) return at->second;
    at->second.plain = plain_form(read_file(folder_ / name));
    for (const std::string_view block : cut_into_blocks(at->second.plain))
      at->second.blocks.emplace(sha256_bytes_of(block), block);
    return at->second;
  }

  std::string plain_of(const RevisionFile& file, const std::string& name) {
    const std::uint64_t most = (std::uint64_t{64} << 20U) + 1000 * file.bytes;  // no map is packed better
    std::string plain;
    for_each_checksum(store_.read(file.root), [&](const std::string& list) {
      for_each_checksum(store_.read(list), [&](const std::string& sha256) {
        if (plain.size() > most)
          throw Error((folder_ / kVisitsBlocks).string() + ": " + name + " would take more than " +
                      std::to_string(most) + " bytes; this revision is lost, the map itself is not");
        if (store_.contains(sha256)) {
          plain += store_.read(sha256);
          return;
        }
        const auto& blocks = present(name).blocks;
        const auto found = blocks.find(sha256);
        if (found == blocks.end())
          throw Error((folder_ / kVisitsBlocks).string() + ": a block of " + name +
                      " is missing; this revision is lost, the map itself is not");
        plain += found->second;
      });
    });
    return plain;
  }
};

bool is_same_file(int file, const fs::path& path) {
  struct stat opened {
  }, named{};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

std::string without_folders(const std::string& source) {
  const std::size_t scheme = source.find(':'), slash = source.find('/');
  if (scheme < slash && scheme != std::string::npos) return source;
  const std::string name = (fs::path(source) / "").parent_path().filename().string();
  return name.empty() ? source : name;
}

std::string time_of_visit() {
  std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  // https://reproducible-builds.org/docs/source-date-epoch
  if (const char* const fixed = std::getenv("SOURCE_DATE_EPOCH")) now = std::strtoll(fixed, nullptr, 10);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

VisitsLock::VisitsLock(const fs::path& folder) {
  const fs::path log = folder / kVisitsLog;
  constexpr int kAttempts = 300;  // the log may be replaced before it is locked
  constexpr std::chrono::milliseconds kPause(100);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    file_ = open(log.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file_ < 0) return;  // no log: nothing to lock
    const bool is_locked = flock(file_, LOCK_EX | LOCK_NB) == 0;
    if (is_locked && is_same_file(file_, log)) return;
    close(std::exchange(file_, -1));
    if (!is_locked) std::this_thread::sleep_for(kPause);
  }
  throw Error(folder.string() +
              ": another program has been saving this map for 30 s; try again when it has ended");
}
VisitsLock::~VisitsLock() {
  if (file_ >= 0) close(file_);
}
VisitsLock::VisitsLock(VisitsLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
VisitsLock& VisitsLock::operator=(VisitsLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

std::vector<Visit> read_visits(const fs::path& folder) {
  const fs::path log = folder / kVisitsLog;
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(log, ignored))) return {};
  const std::string text = read_bytes(log, "the log of a map's revisions", kMaxLog_bytes);
  std::vector<Visit> visits;
  for (std::size_t begin = 0, number = 1; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const auto fail = [&](const char* fault) {
      throw Error(log.string() + ": line " + std::to_string(number) + " " + fault +
                  "; move it away to go on without earlier revisions");
    };
    try {
      visits.push_back(visit_of(text.substr(begin, end - begin)));
    } catch (const std::exception&) {
      fail("is damaged");
    }
    const std::size_t count = visits.size();
    if (visits.back().revision < 1 || (count > 1 && visits[count - 2].revision >= visits.back().revision))
      fail("has a revision out of order");
    if (count > 1 && visits[count - 2].files.empty()) fail("follows a revision without files");
    begin = end + 1;
  }
  return visits;
}

Visit record_visit(const fs::path& folder, const RevisionFiles& files, const fs::path& next,
                   const RevisionFiles& next_files, const VisitNote& note) {
  std::vector<Visit> visits = read_visits(folder);
  if (visits.empty() && !files.empty())  // a map of an earlier version
    visits.push_back({1, time_of_visit(), {"an earlier version", "", {}}, {}});
  const int latest = visits.empty() ? 0 : visits.back().revision;
  if (files.empty() && !visits.empty()) visits.pop_back();  // the present files are damaged: nothing to keep
  share_blocks(folder, next);
  if (!visits.empty() && !files.empty()) {
    BlockStore store(next / kVisitsBlocks);
    visits.back().files = files;
    for (auto& [name, file] : visits.back().files) {
      const auto other = next_files.find(name);
      const bool is_there = other != next_files.end();
      if (is_there && other->second.sha256 == file.sha256) continue;
      file.root = keep_file(folder / name, is_there ? next / name : fs::path(), store);
    }
    store.append();
  }
  visits.push_back({latest + 1, time_of_visit(), note, {}});
  write_bytes(next / kVisitsLog, text_of(visits));
  return visits.back();
}

void extract_revision(const fs::path& folder, const RevisionFiles& files, int revision,
                      const fs::path& into) {
  Restorer restorer(folder, files);
  const Visit& visit = restorer.visit(revision);
  for (const std::string& name : restorer.names_of(visit))
    write_bytes(into / name, restorer.restored(visit, name));
}

int prune_visits(const fs::path& folder, const RevisionFiles& files, int keep) {
  const VisitsLock lock(folder);
  std::vector<Visit> visits = read_visits(folder);
  const int removed = std::max(0, static_cast<int>(visits.size()) - std::max(keep, 1));
  if (removed == 0) return 0;
  visits.erase(visits.begin(), visits.begin() + removed);
  // The log first: blocks that no revision uses do no harm.
  AtomicFile log(folder / kVisitsLog);
  log.stream() << text_of(visits);
  log.commit();
  const VisitsLock lock_of_new_log(folder);
  const fs::path fewer = folder / (std::string(kVisitsBlocks) + ".new");
  fs::remove(fewer);
  {
    const Restorer restorer(folder, files);
    BlockStore kept(fewer);
    for (const Visit& visit : restorer.visits())
      restorer.for_each_block(visit, [&](const std::string& block) {
        if (!kept.contains(block)) kept.add(restorer.store().read(block));
      });
    kept.append();
  }
  std::error_code fault;
  if (fs::exists(fewer))
    fs::rename(fewer, folder / kVisitsBlocks, fault);
  else
    fs::remove(folder / kVisitsBlocks, fault);
  if (fault) throw Error((folder / kVisitsBlocks).string() + ": cannot be replaced: " + system_reason(fault));
  return removed;
}

std::vector<std::string> verify_visits(const fs::path& folder, const RevisionFiles& files) {
  std::vector<std::string> faults;
  try {
    Restorer restorer(folder, files);
    std::set<std::string> sound;
    for (const Visit& visit : restorer.visits()) {
      try {
        restorer.require_whole(visit, sound);
      } catch (const std::exception& error) {
        faults.push_back("revision " + std::to_string(visit.revision) + ": " + error.what());
      }
    }
  } catch (const std::exception& error) {
    faults.emplace_back(error.what());
  }
  return faults;
}

}  // namespace roomradar
