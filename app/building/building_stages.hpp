// building_stages.hpp: lists the jobs of each stage, from recordings to tiles.
//
// Each stage is a manifest of jobs that do not depend on each other. All inputs of a job are named in the
// manifest, so a job is run again only if the content of its inputs has changed.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/building/building_steps.hpp"
#include "app/building/recording_list.hpp"
#include "app/farm/manifest.hpp"
#include "mapping/building/keyframe_retrieval.hpp"

namespace roomradar {

/// Name of a submap, a map of consecutive frames that were tracked without loss; see TrackStep.
struct SubmapName {
  std::string recording;
  int part = 0;
  [[nodiscard]] std::string name() const { return recording + "." + std::to_string(part); }
  /// Folder, relative to BuildingWork::jobs().
  [[nodiscard]] std::string folder() const { return "track-" + recording + "/" + std::to_string(part); }
};

/// Folders and settings for making a building.
struct BuildingWork {
  std::filesystem::path folder;             ///< of the building, absolute
  std::filesystem::path list_folder;        ///< of the list of recordings, absolute
  std::vector<ListedRecording> recordings;  ///< in order of their names
  TileGrid grid;
  PoseOrigin poses = PoseOrigin::kAuto;
  double deviation_m = 0.002;

  /// Folder that contains one folder per job.
  [[nodiscard]] std::filesystem::path jobs() const { return folder / "work"; }
  [[nodiscard]] std::filesystem::path job(const std::string& name) const { return jobs() / name; }
  /// File with the poses of a submap's keyframes in the building's world frame.
  [[nodiscard]] std::filesystem::path placed(const SubmapName& submap) const {
    return jobs() / ("placed-" + submap.name() + ".bin");
  }
};

inline std::string track_job(const std::string& recording) { return "track-" + recording; }
inline std::string fuse_job(const std::string& recording) { return "fuse-" + recording; }
inline std::string join_job(const SubmapName& a, const SubmapName& b) {
  return "join-" + a.name() + "-" + b.name();
}
inline std::string tile_job(const TileIndex& tile) { return "tile-" + name_of(tile); }

/// Returns the submaps of a tracked recording, in order of time.
std::vector<SubmapName> submaps_of(const BuildingWork& work, const std::string& recording);

/// Per tile name: the files to merge, in order, relative to BuildingWork::jobs().
using PartsByTile = std::map<std::string, std::vector<std::string>>;
/// Lists the files that the recordings' fuse jobs wrote, for each tile in which at least one recording has
/// surface.
PartsByTile parts_by_tile(const BuildingWork& work, const std::vector<std::string>& recordings);

// Each function writes a stage's manifest to BuildingWork::jobs() and returns it. Throws Error if the
// manifest cannot be written.

/// One job per recording.
Manifest track_stage(const BuildingWork& work);
/// One job per pair of groups of submaps, and one per group.
Manifest retrieve_stage(const BuildingWork& work, const std::vector<SubmapName>& submaps);
/// Reads the similarities that the retrieve jobs wrote, and selects pairs of submaps to verify.
/// @return indices in `submaps`
std::vector<CandidatePair> read_pairs(const BuildingWork& work, const std::vector<SubmapName>& submaps);
/// One job per pair. A CandidatePair holds indices in `submaps`.
Manifest join_stage(const BuildingWork& work, const std::vector<SubmapName>& submaps,
                    const std::vector<CandidatePair>& pairs);
/// One job per recording, for its submaps in `placed`.
Manifest fuse_stage(const BuildingWork& work, const std::vector<SubmapName>& placed);
/// One job per tile.
Manifest tile_stage(const BuildingWork& work, const PartsByTile& parts_of);

}  // namespace roomradar
