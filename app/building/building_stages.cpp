// building_stages.cpp: writes each job's command line, inputs and outputs.
#include "app/building/building_stages.hpp"

#include <algorithm>
#include <bit>
#include <set>
#include <utility>

#include "mapping/building/keyframe_retrieval.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// A manifest's text, line by line.
class Lines {
 public:
  void begin(const std::string& job) { text_ += job + ":"; }
  void word(const std::string& word) { text_ += " " + quoted_word(word); }
  /// A word that may have { or }.
  void literal(const std::string& text) { text_ += " " + quoted_literal(text); }
  void end() { text_ += "\n"; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

Manifest written(const BuildingWork& work, const char* stage, const Lines& lines) {
  make_folder(work.jobs());
  const fs::path path = work.jobs() / (std::string(stage) + ".jobs");
  write_bytes(path, lines.text());
  return lines.text().empty() ? Manifest{} : read_manifest(path);  // one part alone has no pairs
}

/// A recording's source as a word: relative to the folder of jobs if it is a file or folder, so that a
/// building that is moved with its recordings stays the same.
std::string source_word(const BuildingWork& work, const std::string& recording) {
  const auto listed = std::find_if(work.recordings.begin(), work.recordings.end(),
                                   [&](const ListedRecording& one) { return one.name == recording; });
  const fs::path path = work.list_folder / listed->source;
  std::error_code ignored;
  return fs::exists(path, ignored) ? path.lexically_normal().lexically_proximate(work.jobs()).string()
                                   : listed->source;
}

/// Submaps that are compared by the same retrieve jobs.
struct SubmapGroup {
  std::size_t number = 0;
  std::vector<std::size_t> submaps;  ///< indices, ascending
};

/// Splits submaps into groups of about 16 recordings. A recording's group depends on its name and the number
/// of groups, which doubles as recordings are added, so that few comparisons are done again after a change.
std::vector<SubmapGroup> groups_of(const BuildingWork& work, const std::vector<SubmapName>& submaps) {
  constexpr std::size_t kRecordings = 16, kMaxGroups = 32;
  const std::size_t count = std::min(std::bit_ceil(work.recordings.size() / kRecordings), kMaxGroups);
  std::vector<SubmapGroup> groups(count);
  for (std::size_t i = 0; i < count; ++i) groups[i].number = i;
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    const std::string digits = sha256_of(submaps[i].recording).substr(0, 4);
    groups[std::stoul(digits, nullptr, 16) % count].submaps.push_back(i);
  }
  std::erase_if(groups, [](const SubmapGroup& group) { return group.submaps.empty(); });
  return groups;
}

/// Returns indices of groups, each group with itself included.
std::vector<std::pair<std::size_t, std::size_t>> pairs_of_groups(const std::vector<SubmapGroup>& groups) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t b = 0; b < groups.size(); ++b)
    for (std::size_t a = 0; a <= b; ++a) pairs.emplace_back(a, b);
  return pairs;
}

// No folder may have the name of a step, "retrieve".
std::string retrieve_job(const SubmapGroup& a, const SubmapGroup& b) {
  return "similar-" + std::to_string(a.number) + "-" + std::to_string(b.number);
}

std::string features_file(const SubmapName& submap) { return submap.folder() + "/" + kFeaturesFile; }

void begin_step(Lines& lines, const std::string& job, const char* step) {
  lines.begin(job);
  lines.word("building-step");
  lines.word(step);
}

void add_grid(Lines& lines, const TileGrid& grid) {
  lines.word("--resolution=" + format_number(grid.resolution_m));
  lines.word("--tile-edge=" + std::to_string(grid.edge_voxels));
}

}  // namespace

Manifest track_stage(const BuildingWork& work) {
  Lines lines;
  for (const ListedRecording& recording : work.recordings) {
    begin_step(lines, track_job(recording.name), "track");
    lines.literal(source_word(work, recording.name));
    lines.word("--poses=" + std::string(to_string(work.poses)));
    lines.word("--out={}");
    lines.end();
  }
  return written(work, "track", lines);
}

Manifest retrieve_stage(const BuildingWork& work, const std::vector<SubmapName>& submaps) {
  const std::vector<SubmapGroup> groups = groups_of(work, submaps);
  Lines lines;
  for (const auto& [a, b] : pairs_of_groups(groups)) {
    begin_step(lines, retrieve_job(groups[a], groups[b]), "retrieve");
    for (const std::size_t i : groups[a].submaps) lines.word(features_file(submaps[i]));
    if (a != b)
      for (const std::size_t i : groups[b].submaps) lines.word("--with=" + features_file(submaps[i]));
    lines.word("--out={}");
    lines.end();
  }
  return written(work, "retrieve", lines);
}

std::vector<CandidatePair> read_pairs(const BuildingWork& work, const std::vector<SubmapName>& submaps) {
  const std::vector<SubmapGroup> groups = groups_of(work, submaps);
  std::vector<SubmapSimilarity> similarities(submaps.size());
  for (const auto& [a, b] : pairs_of_groups(groups)) {
    const std::vector<std::size_t>&of_a = groups[a].submaps, &of_b = groups[b].submaps;
    const fs::path path = work.job(retrieve_job(groups[a], groups[b])) / kSimilarityFile;
    const GroupSimilarity found = load_similarity(path, of_a.size(), a == b ? 0 : of_b.size());
    const auto add = [&](std::size_t submap, const SubmapSimilarity& similarity,
                         const std::vector<std::size_t>& others) {
      if (!add_similar(similarities[submap], similarity, others))
        throw Error(path.string() + ": is damaged: " + submaps[submap].name() + " has other keyframes there");
    };
    for (std::size_t i = 0; i < found.a.size(); ++i) add(of_a[i], found.a[i], of_b);
    for (std::size_t i = 0; i < found.b.size(); ++i) add(of_b[i], found.b[i], of_a);
  }
  return choose_pairs(similarities);
}

Manifest join_stage(const BuildingWork& work, const std::vector<SubmapName>& submaps,
                    const std::vector<CandidatePair>& pairs) {
  Lines lines;
  for (const CandidatePair& pair : pairs) {
    begin_step(lines, join_job(submaps[pair.a], submaps[pair.b]), "join");
    lines.word(submaps[pair.a].folder());
    lines.word(submaps[pair.b].folder());
    lines.word("--out={}");
    lines.end();
  }
  return written(work, "join", lines);
}

Manifest fuse_stage(const BuildingWork& work, const std::vector<SubmapName>& placed) {
  std::map<std::string, std::vector<SubmapName>> by_recording;
  for (const SubmapName& submap : placed) by_recording[submap.recording].push_back(submap);
  Lines lines;
  for (const auto& [recording, submaps] : by_recording) {
    begin_step(lines, fuse_job(recording), "fuse");
    lines.literal(source_word(work, recording));
    for (const SubmapName& submap : submaps) {
      lines.word("--submap=" + submap.folder());
      lines.word("--placed=" + work.placed(submap).filename().string());
    }
    add_grid(lines, work.grid);
    if (work.poses == PoseOrigin::kRecorded) lines.word("--keep-ghosts");
    lines.word("--out={}");
    lines.end();
  }
  return written(work, "fuse", lines);
}

std::vector<SubmapName> submaps_of(const BuildingWork& work, const std::string& recording) {
  std::vector<SubmapName> submaps;
  std::error_code ignored;
  for (SubmapName next{recording, 0}; fs::is_directory(work.jobs() / next.folder(), ignored); ++next.part)
    submaps.push_back(next);
  return submaps;
}

Manifest tile_stage(const BuildingWork& work, const PartsByTile& parts_of) {
  Lines lines;
  for (const auto& [tile, parts] : parts_of) {
    begin_step(lines, tile_job(tile_of_name(tile)), "tile");
    lines.word("--tile=" + tile);
    for (const std::string& part : parts) lines.word(part);
    add_grid(lines, work.grid);
    lines.word("--deviation=" + format_number(work.deviation_m));
    lines.word("--unknown-cells=" + format_number(kTileUnknownCells));
    lines.word("--out={}");
    lines.end();
  }
  return written(work, "tile", lines);
}

PartsByTile parts_by_tile(const BuildingWork& work, const std::vector<std::string>& recordings) {
  PartsByTile parts_of;
  std::set<std::string> with_surface;
  for (const std::string& recording : recordings)
    for (const std::string folder : {"parts", "margins"}) {
      const std::string relative = fuse_job(recording) + "/" + folder;
      for (const fs::path& file : entries_of(work.jobs() / relative)) {
        const std::string tile = file.stem().string();
        if (file.extension() != ".octree") continue;
        if (folder == "parts") with_surface.insert(tile);
        parts_of[tile].push_back(relative + "/" + file.filename().string());
      }
    }
  std::erase_if(parts_of, [&](const auto& entry) { return !with_surface.contains(entry.first); });
  return parts_of;
}

}  // namespace roomradar
