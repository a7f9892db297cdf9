// building_stages.cpp: words of the jobs.
#include "app/building/building_stages.hpp"

#include <algorithm>
#include <set>

#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/make_folder.hpp"

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
  Lines lines;
  begin_step(lines, kRetrieveJob, "retrieve");
  for (const SubmapName& submap : submaps) lines.word(submap.folder());
  lines.word("--out={}");
  lines.end();
  return written(work, "retrieve", lines);
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
      for (const fs::directory_entry& file : fs::directory_iterator(work.jobs() / relative)) {
        const std::string tile = file.path().stem().string();
        if (file.path().extension() != ".octree") continue;
        if (folder == "parts") with_surface.insert(tile);
        parts_of[tile].push_back(relative + "/" + file.path().filename().string());
      }
    }
  std::erase_if(parts_of, [&](const auto& entry) { return !with_surface.contains(entry.first); });
  return parts_of;
}

}  // namespace roomradar
