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
#include "mapping/building/join_choice.hpp"
#include "mapping/building/submap_join.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kHashDigits = 16;  // of the SHA-256, in names of files
constexpr const char* kKeyframeExtension = ".keyframes";

std::string sentence_of(const StageCounts& counts, const std::string& outcome) {
  std::string text = counts.stage + ": " + outcome;
  if (counts.present > 0)
    text += "; " + std::to_string(counts.present) + " of " +
            std::to_string(counts.present + counts.done + counts.failed) + " jobs were done before";
  if (counts.failed > 0) text += "; " + std::to_string(counts.failed) + " failed";
  return text;
}

/// Throws if a job failed whose result the building cannot be without.
void require_all(const StageCounts& counts) {
  if (counts.failed == 0) return;
  throw Error(std::to_string(counts.failed) + " of the jobs '" + counts.stage + "' failed, for instance " +
              counts.faults.front() + "; the same command tries them again");
}

/// The work, the jobs of the stages so far, and the listener to progress.
struct Stages {
  const BuildingWork& work;
  const RunStage& run_stage;
  const std::function<void(const std::string&)>& show;
  std::vector<StageCounts> counts{};    // one per stage so far
  std::set<std::string> failed_jobs{};  // names

  /// Plans and runs a stage. Counts its jobs. Throws Error if the stage is stopped.
  StageCounts run(const std::string& stage, Manifest manifest);
};

StageCounts Stages::run(const std::string& stage, Manifest manifest) {
  StageCounts& counted = counts.emplace_back();
  counted.stage = stage;
  if (manifest.jobs.empty()) return counted;
  const auto begin = std::chrono::steady_clock::now();
  const FarmPlan plan = plan_farm(std::move(manifest), work.jobs());
  const FarmState state = run_stage(stage, plan);
  counted.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  counted.done = state.schedule.count(JobState::kDone);
  counted.present = state.schedule.count(JobState::kPresent);
  for (const auto& [job, result] : state.results) {
    counted.cpu_s += result.cpu_s;
    counted.peak_mb = std::max(counted.peak_mb, result.peak_mb);
    if (result.is_done) continue;
    const std::string& name = plan.manifest.jobs[job].name;
    failed_jobs.insert(name);
    counted.faults.push_back(name + ": " + result.fault);
  }
  counted.failed = counted.faults.size();
  if (counted.done + counted.present + counted.failed < plan.jobs.size())
    throw Error(work.folder.string() + ": stopped; run the same command again to finish the rest");
  return counted;
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

/// Submaps of all tracked recordings, without features.
struct TrackedSubmaps {
  std::vector<SubmapName> names;
  std::vector<Submap> submaps;  // one per name
};

/// Tracks each recording alone. Leaves out those that cannot be tracked.
TrackedSubmaps run_track_stage(Stages& stages) {
  const BuildingWork& work = stages.work;
  const StageCounts counts = stages.run("track", track_stage(work));
  TrackedSubmaps tracked;
  for (const ListedRecording& recording : work.recordings) {
    if (stages.failed_jobs.contains(track_job(recording.name))) continue;
    for (const SubmapName& name : submaps_of(work, recording.name)) {
      tracked.names.push_back(name);
      tracked.submaps.push_back(load_submap_poses(work.jobs() / name.folder()));
    }
  }
  stages.show(sentence_of(counts, std::to_string(work.recordings.size()) + " recordings, " +
                                      std::to_string(tracked.names.size()) + " parts"));
  if (tracked.names.empty()) require_all(counts);
  return tracked;
}

/// Finds pairs of submaps that may show the same place.
std::vector<CandidatePair> run_retrieve_stage(Stages& stages, const TrackedSubmaps& tracked) {
  require_all(stages.run("retrieve", retrieve_stage(stages.work, tracked.names)));
  return read_pairs(stages.work, tracked.names);
}

struct MeasuredJoins {
  std::vector<JoinedPair> pairs;            // all joins
  std::vector<GraphJoin> joined;            // those with the status kJoined
  std::vector<std::size_t> pair_of_joined;  // per join in `joined`: its index in `pairs`
  std::vector<GraphJoin> refused;           // the others
};

/// Verifies the pairs, and measures their relative poses.
MeasuredJoins run_join_stage(Stages& stages, const TrackedSubmaps& tracked,
                             const std::vector<CandidatePair>& candidates) {
  const std::vector<SubmapName>& names = tracked.names;
  const StageCounts counts = stages.run("join", join_stage(stages.work, names, candidates));
  require_all(counts);
  MeasuredJoins joins;
  for (const CandidatePair& pair : candidates)
    for (SubmapJoin& join :
         load_joins(stages.work.job(join_job(names[pair.a], names[pair.b])) / "joins.bin")) {
      const bool is_joined = join.status == JoinStatus::kJoined;
      if (is_joined) joins.pair_of_joined.push_back(joins.pairs.size());
      joins.pairs.push_back({names[pair.a], names[pair.b], join});
      (is_joined ? joins.joined : joins.refused).push_back({pair.a, pair.b, std::move(join)});
    }
  stages.show(sentence_of(counts, std::to_string(candidates.size()) + " pairs may meet, " +
                                      std::to_string(joins.joined.size()) + " joins"));
  return joins;
}

/// Solves for the poses of all submaps.
BuildingGraph solve(const BuildingWork& work, const TrackedSubmaps& tracked,
                    const std::vector<GraphJoin>& joins) {
  SubmapReader reader(work, tracked.names);
  const TestOverlap test_overlap = [&reader](std::size_t a, std::size_t b,
                                             std::span<const PredictedPair> predicted) {
    return test_placement(*reader.read(a), *reader.read(b), predicted);
  };
  return solve_building(graph_submaps(work, tracked.names, tracked.submaps), joins, test_overlap);
}

/// Marks the joins that the solution uses. Adds the others to the refused joins.
void refuse_unused(const BuildingGraph& graph, MeasuredJoins& joins) {
  for (std::size_t i = 0; i < joins.joined.size(); ++i) {
    JoinedPair& pair = joins.pairs[joins.pair_of_joined[i]];
    pair.is_used = graph.is_used[i];
    pair.off_m = graph.off_m[i];
    if (!pair.is_used) joins.refused.push_back(joins.joined[i]);
  }
}

/// Returns the connected part with the most frames.
std::size_t largest_part(const BuildingGraph& graph, const std::vector<Submap>& submaps) {
  std::vector<std::size_t> frames_of_part(graph.parts, 0);
  for (std::size_t i = 0; i < submaps.size(); ++i)
    frames_of_part[graph.submaps[i].part] += submaps[i].trajectory.size();
  return static_cast<std::size_t>(std::max_element(frames_of_part.begin(), frames_of_part.end()) -
                                  frames_of_part.begin());
}

/// The submaps of the building's connected part, in the building's world frame.
struct PlacedSubmaps {
  std::vector<SubmapName> names;
  std::map<std::string, PlacedFrames> frames;  // by recording
  std::vector<BuildingRecording> recordings;   // all tracked ones, also those that are not placed
  std::size_t kept = 0;                        // number of submaps with the poses of the last run
  std::vector<LookAlike> look_alikes;
};

/// Adds a submap's frames and keyframes to the counts of its recording.
BuildingRecording& counted_recording(const SubmapName& name, const Submap& submap,
                                     std::vector<BuildingRecording>& recordings) {
  if (recordings.empty() || recordings.back().name != name.recording)
    recordings.push_back({name.recording, submap.source, submap.frames_read});
  BuildingRecording& recording = recordings.back();
  recording.frames_tracked += static_cast<std::int64_t>(submap.trajectory.size());
  recording.keyframes += static_cast<std::int64_t>(submap.keyframes.keyframes.size());
  return recording;
}

/// Places all submaps in one world frame. The connected part with the most frames is the building.
PlacedSubmaps run_place_stage(const Stages& stages, const TrackedSubmaps& tracked, MeasuredJoins& joins) {
  const BuildingGraph graph = solve(stages.work, tracked, joins.joined);
  refuse_unused(graph, joins);
  const std::size_t building_part = largest_part(graph, tracked.submaps);
  PlacedSubmaps all;
  all.look_alikes = find_look_alikes(graph.submaps, building_part, joins.refused);
  for (std::size_t i = 0; i < tracked.names.size(); ++i) {
    const SubmapName& name = tracked.names[i];
    const Submap& submap = tracked.submaps[i];
    const PlacedSubmap& placed = graph.submaps[i];
    BuildingRecording& recording = counted_recording(name, submap, all.recordings);
    if (placed.part != building_part) continue;
    recording.frames_placed += static_cast<std::int64_t>(submap.trajectory.size());
    all.kept += placed.was_kept ? 1 : 0;
    save_placed_keyframes(placed.T_building_keyframe, stages.work.placed(name));
    all.names.push_back(name);
    PlacedFrames& frames = all.frames[name.recording];
    const std::vector<TimedPose> own = corrected_trajectory(submap, placed.T_building_keyframe);
    frames.trajectory.insert(frames.trajectory.end(), own.begin(), own.end());
    frames.recorded.insert(frames.recorded.end(), submap.recorded.begin(), submap.recorded.end());
  }
  stages.show("place: " + std::to_string(all.names.size()) + " of " + std::to_string(tracked.names.size()) +
              " parts are connected, " +
              std::to_string(std::count(graph.is_used.begin(), graph.is_used.end(), true)) + " of " +
              std::to_string(joins.joined.size()) + " joins agree");
  return all;
}

/// Fuses each recording's placed frames, and splits the result into tiles.
PartsByTile run_fuse_stage(Stages& stages, const PlacedSubmaps& placed) {
  require_all(stages.run("fuse", fuse_stage(stages.work, placed.names)));
  std::vector<std::string> fused;
  for (const auto& [recording, frames] : placed.frames) fused.push_back(recording);
  return parts_by_tile(stages.work, fused);
}

/// Merges the parts of each tile, and extracts its surface.
StageCounts run_tile_stage(Stages& stages, const PartsByTile& parts_of) {
  StageCounts counts = stages.run("tile", tile_stage(stages.work, parts_of));
  require_all(counts);
  return counts;
}

/// Puts the files of tiles and keyframes into the building, and lists them in `info`.
void store_files(const BuildingWork& work, const PartsByTile& parts_of, BuildingInfo& info) {
  make_folder(work.folder / kTilesFolder);
  make_folder(work.folder / kRecordingsFolder);
  ContentHashes hashes(work.jobs() / "results.sha256");
  for (const auto& [name, parts] : parts_of) {
    const json facts =
        json::parse(read_bytes(work.job(tile_job(tile_of_name(name))) / "tile.json", "a tile's numbers"));
    if (facts.at("triangles").get<std::int64_t>() > 0)
      info.tiles.push_back(stored_tile(work, name, facts, hashes));
  }
  std::sort(info.tiles.begin(), info.tiles.end(),
            [](const BuildingTile& a, const BuildingTile& b) { return is_before(a.index, b.index); });
  for (BuildingRecording& recording : info.recordings)
    if (recording.frames_placed > 0)
      recording.keyframe_file =
          store(work.job(fuse_job(recording.name)) / kPlacedKeyframesFile, work.folder,
                fs::path(kRecordingsFolder) / recording.name, kKeyframeExtension, hashes);
  hashes.save();
}

/// Writes trajectories, tileset and building.json, then deletes the files of earlier tiles and keyframes.
void finish_folder(const BuildingWork& work, const PlacedSubmaps& placed, const BuildingInfo& info) {
  for (const auto& [recording, frames] : placed.frames)
    write_trajectory(work.folder / kRecordingsFolder / (recording + ".trajectory.txt"), frames.trajectory);
  write_tileset(info, work.folder);
  write_building(info, work.folder);
  delete_others(info, work.folder);
}

}  // namespace

BuildingResult build_building(const BuildingWork& work, const RunStage& run_stage,
                              const std::function<void(const std::string&)>& show) {
  require_valid(work.grid);
  Stages stages{work, run_stage, show};
  const TrackedSubmaps tracked = run_track_stage(stages);
  const std::vector<CandidatePair> candidates = run_retrieve_stage(stages, tracked);
  MeasuredJoins joins = run_join_stage(stages, tracked, candidates);
  const PlacedSubmaps placed = run_place_stage(stages, tracked, joins);
  const PartsByTile parts_of = run_fuse_stage(stages, placed);
  const StageCounts tiled = run_tile_stage(stages, parts_of);

  BuildingResult result;
  result.info.grid = work.grid;
  result.info.recordings = placed.recordings;
  result.info.look_alikes = placed.look_alikes;
  store_files(work, parts_of, result.info);
  finish_folder(work, placed, result.info);
  show(sentence_of(tiled, std::to_string(result.info.tiles.size()) + " tiles with surface"));

  result.stages = std::move(stages.counts);
  result.joins = std::move(joins.pairs);
  result.kept = placed.kept;
  result.recorded_error = recorded_error(placed.frames);
  return result;
}

}  // namespace roomradar
