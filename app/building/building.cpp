// building.cpp: the stages in order, and the files of the finished building.
#include "app/building/building.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "app/building/tileset.hpp"
#include "app/farm/content_hashes.hpp"
#include "mapping/building/look_alikes.hpp"
#include "mapping/building/submap_join_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folder_entries.hpp"
#include "mapping/types/system/make_folder.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kHashDigits = 16;  // of the SHA-256, in names of files
constexpr const char* kKeyframeExtension = ".keyframes";

/// Plans and runs a stage. Counts its jobs.
StageCounts run_counted(const BuildingWork& work, const std::string& stage, Manifest manifest,
                        const RunStage& run_stage, std::set<std::string>& failed) {
  StageCounts counts;
  counts.stage = stage;
  if (manifest.jobs.empty()) return counts;
  const auto begin = std::chrono::steady_clock::now();
  const FarmPlan plan = plan_farm(std::move(manifest), work.jobs());
  const FarmState state = run_stage(stage, plan);
  counts.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  counts.done = state.schedule.count(JobState::kDone);
  counts.present = state.schedule.count(JobState::kPresent);
  for (const auto& [job, result] : state.results) {
    counts.cpu_s += result.cpu_s;
    counts.peak_mb = std::max(counts.peak_mb, result.peak_mb);
    if (result.is_done) continue;
    const std::string& name = plan.manifest.jobs[job].name;
    failed.insert(name);
    counts.faults.push_back(name + ": " + result.fault);
  }
  counts.failed = counts.faults.size();
  if (counts.done + counts.present + counts.failed < plan.jobs.size())
    throw Error(work.folder.string() + ": stopped; run the same command again to finish the rest");
  return counts;
}

/// Throws if a job failed whose result the building cannot be without.
void require_all(const StageCounts& counts) {
  if (counts.failed == 0) return;
  throw Error(std::to_string(counts.failed) + " of the jobs '" + counts.stage + "' failed, for instance " +
              counts.faults.front() + "; the same command tries them again");
}

std::vector<GraphSubmap> graph_submaps(const BuildingWork& work, const std::vector<SubmapName>& names,
                                       const std::vector<Submap>& submaps) {
  std::vector<GraphSubmap> graph(submaps.size());
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    for (const MapKeyframe& keyframe : submaps[i].keyframes.keyframes)
      graph[i].T_submap_keyframe.push_back(keyframe.T_world_camera);
    std::error_code ignored;
    if (fs::exists(work.placed(names[i]), ignored)) try {
        graph[i].T_building_keyframe = load_placed_keyframes(work.placed(names[i]));
      } catch (const Error&) {
        graph[i].T_building_keyframe.clear();  // damaged: placed once more
      }
  }
  return graph;
}

/// Reads submaps with their features, of which it keeps the last few.
class SubmapReader {
 public:
  SubmapReader(const BuildingWork& work, const std::vector<SubmapName>& names) : work_(work), names_(names) {}

  std::shared_ptr<const Submap> read(std::size_t submap) {
    constexpr std::size_t kKept = 8;
    for (const auto& [index, kept] : kept_)
      if (index == submap) return kept;
    if (kept_.size() == kKept) kept_.pop_front();
    auto read = std::make_shared<const Submap>(load_submap(work_.jobs() / names_[submap].folder()));
    return kept_.emplace_back(submap, std::move(read)).second;
  }

 private:
  const BuildingWork& work_;
  const std::vector<SubmapName>& names_;
  std::deque<std::pair<std::size_t, std::shared_ptr<const Submap>>> kept_;
};

/// Poses of a recording's placed frames in the building, and those that it states.
struct PlacedFrames {
  std::vector<TimedPose> trajectory, recorded;
};

TrajectoryError recorded_error(const std::map<std::string, PlacedFrames>& placed) {
  std::vector<TimedPose> estimate, recorded;
  constexpr std::int64_t kApart = 1'000'000'000;  // frame numbers of two recordings do not meet
  std::int64_t offset = 0;
  const auto append = [&offset](const std::vector<TimedPose>& from, std::vector<TimedPose>& to) {
    for (TimedPose pose : from) {
      pose.frame_index += offset;
      to.push_back(pose);
    }
  };
  for (const auto& [name, frames] : placed) {
    append(frames.trajectory, estimate);
    append(frames.recorded, recorded);
    offset += kApart;
  }
  return absolute_trajectory_error(estimate, recorded);
}

/// Puts a file of a job into the building under a name with its hash. A file of that name and size that is
/// there stays.
/// @param stem  folder in the building, and the name's begin
ContentFile store(const fs::path& from, const fs::path& folder, const fs::path& stem,
                  const std::string& extension, ContentHashes& hashes) {
  ContentFile file;
  file.sha256 = hashes.of(from);
  file.bytes = fs::file_size(from);
  file.name = stem.generic_string() + "." + file.sha256.substr(0, kHashDigits) + extension;
  const fs::path to = folder / file.name;
  std::error_code fault;
  if (fs::exists(to, fault) && fs::file_size(to) == file.bytes) return file;
  fs::remove(to, fault);
  fs::create_hard_link(from, to, fault);
  if (fault) fs::copy_file(from, to, fs::copy_options::overwrite_existing);
  return file;
}

BuildingTile stored_tile(const BuildingWork& work, const std::string& name, const json& facts,
                         ContentHashes& hashes) {
  const fs::path job = work.job(tile_job(tile_of_name(name)));
  const auto vector = [&](const char* key) {
    const json& value = facts.at(key);
    return Eigen::Vector3d(value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>());
  };
  BuildingTile tile;
  tile.index = tile_of_name(name);
  tile.triangles = facts.at("triangles").get<std::int64_t>();
  tile.surface_world = {vector("surface_min_m"), vector("surface_max_m")};
  tile.mesh_origin = vector("mesh_origin_m");
  const fs::path stem = fs::path(kTilesFolder) / name;
  tile.octree = store(job / "tile.octree", work.folder, stem, ".octree", hashes);
  tile.mesh = store(job / "tile.mesh", work.folder, stem, ".mesh", hashes);
  tile.glb = store(job / "tile.glb", work.folder, stem, ".glb", hashes);
  tile.unknown = store(job / "tile.unknown", work.folder, stem, ".unknown", hashes);
  return tile;
}

/// Returns whether the file has the name that store() gives to a recording's keyframes.
bool is_keyframe_file(const fs::path& path) {
  const std::string hash = path.stem().extension().string();  // with its dot
  return path.extension() == kKeyframeExtension && hash.size() == kHashDigits + 1 &&
         hash.find_first_not_of("0123456789abcdef", 1) == std::string::npos;
}

/// Deletes files of tiles and keyframes that are not part of the building any more. Other files in the folder
/// of recordings stay.
void delete_others(const BuildingInfo& info, const fs::path& folder) {
  std::set<std::string> used;
  for (const BuildingTile& tile : info.tiles)
    for (const ContentFile* file : files_of(tile)) used.insert(file->name);
  for (const BuildingRecording& recording : info.recordings) used.insert(recording.keyframe_file.name);
  std::vector<fs::path> others;
  for (const char* part : {kTilesFolder, kRecordingsFolder})
    for (const fs::path& entry : entries_of(folder / part)) {
      const fs::path name = fs::path(part) / entry.filename();
      if ((part == kTilesFolder || is_keyframe_file(name)) && !used.contains(name.generic_string()))
        others.push_back(entry);
    }
  for (const fs::path& other : others) {
    std::error_code ignored;
    fs::remove(other, ignored);
  }
}

std::string sentence_of(const StageCounts& counts, const std::string& outcome) {
  std::string text = counts.stage + ": " + outcome;
  if (counts.present > 0)
    text += "; " + std::to_string(counts.present) + " of " +
            std::to_string(counts.present + counts.done + counts.failed) + " jobs were done before";
  if (counts.failed > 0) text += "; " + std::to_string(counts.failed) + " failed";
  return text;
}

}  // namespace

BuildingResult build_building(const BuildingWork& work, const RunStage& run_stage,
                              const std::function<void(const std::string&)>& show) {
  require_valid(work.grid);
  BuildingResult result;
  std::set<std::string> failed;
  const auto stage = [&](const char* name, Manifest manifest) -> StageCounts& {
    return result.stages.emplace_back(run_counted(work, name, std::move(manifest), run_stage, failed));
  };

  // Each recording alone. Those that cannot be tracked are left out.
  const StageCounts tracked = stage("track", track_stage(work));
  std::vector<SubmapName> names;
  std::vector<Submap> submaps;  // without features
  for (const ListedRecording& recording : work.recordings) {
    if (failed.contains(track_job(recording.name))) continue;
    for (const SubmapName& name : submaps_of(work, recording.name)) {
      names.push_back(name);
      submaps.push_back(load_submap_poses(work.jobs() / name.folder()));
    }
  }
  show(sentence_of(tracked, std::to_string(work.recordings.size()) + " recordings, " +
                                std::to_string(names.size()) + " parts"));
  if (names.empty()) require_all(tracked);

  // Pairs that meet.
  require_all(stage("retrieve", retrieve_stage(work, names)));
  const std::vector<CandidatePair> pairs = read_pairs(work, names);
  const StageCounts joined = stage("join", join_stage(work, names, pairs));
  require_all(joined);
  std::vector<GraphJoin> joins, refused;
  for (const CandidatePair& pair : pairs)
    for (SubmapJoin& join : load_joins(work.job(join_job(names[pair.a], names[pair.b])) / "joins.bin")) {
      result.joins.push_back({names[pair.a], names[pair.b], join});
      (join.status == JoinStatus::kJoined ? joins : refused).push_back({pair.a, pair.b, std::move(join)});
    }
  show(sentence_of(
      joined, std::to_string(pairs.size()) + " pairs may meet, " + std::to_string(joins.size()) + " joins"));

  // All submaps in one world frame. The connected part with the most frames is the building.
  SubmapReader reader(work, names);
  const TestOverlap test_overlap = [&reader](std::size_t a, std::size_t b,
                                             std::span<const PredictedPair> predicted) {
    return test_placement(*reader.read(a), *reader.read(b), predicted);
  };
  const BuildingGraph graph = solve_building(graph_submaps(work, names, submaps), joins, test_overlap);
  std::size_t at = 0;
  for (JoinedPair& pair : result.joins) {
    if (pair.join.status != JoinStatus::kJoined) continue;
    pair.is_used = graph.is_used[at];
    pair.off_m = graph.off_m[at];
    if (!pair.is_used) refused.push_back(joins[at]);
    ++at;
  }
  std::vector<std::size_t> frames_of_part(graph.parts, 0);
  for (std::size_t i = 0; i < names.size(); ++i)
    frames_of_part[graph.submaps[i].part] += submaps[i].trajectory.size();
  const auto building_part = static_cast<std::size_t>(
      std::max_element(frames_of_part.begin(), frames_of_part.end()) - frames_of_part.begin());
  result.info.look_alikes = find_look_alikes(graph.submaps, building_part, refused);
  std::vector<SubmapName> placed_names;
  std::map<std::string, PlacedFrames> placed_frames;  // by recording
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PlacedSubmap& placed = graph.submaps[i];
    if (result.info.recordings.empty() || result.info.recordings.back().name != names[i].recording)
      result.info.recordings.push_back({names[i].recording, submaps[i].source, submaps[i].frames_read});
    BuildingRecording& recording = result.info.recordings.back();
    const auto frames = static_cast<std::int64_t>(submaps[i].trajectory.size());
    recording.frames_tracked += frames;
    recording.keyframes += static_cast<std::int64_t>(submaps[i].keyframes.keyframes.size());
    if (placed.part != building_part) continue;
    recording.frames_placed += frames;
    result.kept += placed.was_kept ? 1 : 0;
    save_placed_keyframes(placed.T_building_keyframe, work.placed(names[i]));
    placed_names.push_back(names[i]);
    PlacedFrames& all = placed_frames[names[i].recording];
    const std::vector<TimedPose> own = corrected_trajectory(submaps[i], placed.T_building_keyframe);
    all.trajectory.insert(all.trajectory.end(), own.begin(), own.end());
    all.recorded.insert(all.recorded.end(), submaps[i].recorded.begin(), submaps[i].recorded.end());
  }
  result.recorded_error = recorded_error(placed_frames);
  show("place: " + std::to_string(placed_names.size()) + " of " + std::to_string(names.size()) +
       " parts are connected, " +
       std::to_string(std::count(graph.is_used.begin(), graph.is_used.end(), true)) + " of " +
       std::to_string(joins.size()) + " joins agree");

  // Tiles.
  require_all(stage("fuse", fuse_stage(work, placed_names)));
  std::vector<std::string> fused;
  for (const auto& [recording, frames] : placed_frames) fused.push_back(recording);
  const PartsByTile parts_of = parts_by_tile(work, fused);
  const StageCounts tiled = stage("tile", tile_stage(work, parts_of));
  require_all(tiled);
  result.info.grid = work.grid;
  make_folder(work.folder / kTilesFolder);
  make_folder(work.folder / kRecordingsFolder);
  ContentHashes hashes(work.jobs() / "results.sha256");
  for (const auto& [name, parts] : parts_of) {
    const json facts =
        json::parse(read_bytes(work.job(tile_job(tile_of_name(name))) / "tile.json", "a tile's numbers"));
    if (facts.at("triangles").get<std::int64_t>() > 0)
      result.info.tiles.push_back(stored_tile(work, name, facts, hashes));
  }
  std::sort(result.info.tiles.begin(), result.info.tiles.end(),
            [](const BuildingTile& a, const BuildingTile& b) { return is_before(a.index, b.index); });
  for (BuildingRecording& recording : result.info.recordings)
    if (recording.frames_placed > 0)
      recording.keyframe_file =
          store(work.job(fuse_job(recording.name)) / kPlacedKeyframesFile, work.folder,
                fs::path(kRecordingsFolder) / recording.name, kKeyframeExtension, hashes);
  hashes.save();
  for (const auto& [recording, frames] : placed_frames)
    write_trajectory(work.folder / kRecordingsFolder / (recording + ".trajectory.txt"), frames.trajectory);
  write_tileset(result.info, work.folder);
  write_building(result.info, work.folder);
  delete_others(result.info, work.folder);
  show(sentence_of(tiled, std::to_string(result.info.tiles.size()) + " tiles with surface"));
  return result;
}

}  // namespace roomradar
