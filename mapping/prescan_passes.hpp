// prescan_passes.hpp: the stages of a prescan that read the source, namely tracking, fusion and ghost
// removal.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapping/prescan.hpp"
#include "mapping/prescan_state.hpp"

namespace roomradar {

/// State shared by all stages of one prescan.
struct PrescanWork {
  FrameSource* source;  ///< never null; the second pass reads a DeskewedSource
  const PrescanConfig& config;
  StageTimes& times;
  const PrescanProgress& progress;
  Checkpoints* checkpoints = nullptr;
  double reach_m = 0.0;                          ///< half the edge of the octree's cube, m
  bool maps_recorded_world = false;              ///< true if recorded poses are in the octree's world frame
  ScanObserver* observer = nullptr;              ///< null: none
  std::map<std::int64_t, double> track_ms = {};  ///< tracking time by frame index
  std::optional<FuseStatus> last_fused = {};     ///< status of the last frame passed to fuse()

  void show(const std::string& stage, const std::string& note) const {
    if (progress) progress(stage, note);
  }
};

/// Runs the first pass (tracking), from its beginning or from a checkpoint. Returns the initial state of the
/// second pass (fusion). If the checkpoint is of the second pass, returns the state stored in it instead.
/// @param map  map to extend; its octree moves into the result
/// @throws Error as prescan() does
FusionPass run_tracking_pass(PrescanWork& work, std::optional<SavedMap>& map);

/// Runs the second pass (fusion). Starts the pass from its beginning or resumes it from a checkpoint. Does
/// nothing if the checkpoint was written after fusion.
/// @param trajectory  poses of the frames to fuse, in the map's world frame
void run_fusion_pass(PrescanWork& work, const std::vector<TimedPose>& trajectory, FusionPass& pass);

/// Removes ghosts, then fuses their surroundings again. Starts this stage from its beginning or resumes it
/// from a checkpoint. Does nothing if the checkpoint was written after this stage. Sets pass.ghost_voxels.
void run_ghost_removal(PrescanWork& work, FusionPass& pass);

}  // namespace roomradar
