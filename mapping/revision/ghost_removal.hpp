// ghost_removal.hpp: takes out of the static map what moved on while the room was scanned.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "mapping/revision/ghosts.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// A frame that was fused, and where to find it again.
struct FusedFrame {
  std::int64_t position = 0;  ///< in the source: how many reads come before its own
  std::int64_t frame_index = 0;
  Intrinsics depth_camera;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// What moved on, out of the map, and how far the second look at where it was has come.
struct GhostRevision {
  GhostVotes::Verdicts verdicts;  ///< still and unseen: only what lies near the others
  std::uint64_t next = 0;         ///< the first of the fused frames that is not looked at again

  [[nodiscard]] std::int64_t voxels() const {
    return static_cast<std::int64_t>(verdicts.ghosts.size() + verdicts.absent.size());
  }
};

/// Called after each frame that was looked at.
using GhostProgress = std::function<void(const std::string& note)>;

/// Reads the source again to find the surface that frames see through, which becomes free, and what is gone
/// with nothing measured behind, which becomes unknown; forgets the signed distances round both. Stages
/// timed: read, ghosts (of one frame).
///
/// @throws Error if the source cannot be rewound or the config is out of its rules
GhostRevision take_out_ghosts(FrameSource& source, std::span<const FusedFrame> fused,
                              const GhostConfig& config, StaticMap& map, StageTimes& times,
                              const GhostProgress& progress = {});

/// Fuses anew, from revision.next on, what lies round what was taken out: without the pixels that saw it, as
/// they pulled the real surface behind towards them. Between two frames, as when `progress` is called, map
/// and revision are all that is needed to go on. Nothing is read if nothing was taken out.
///
/// @throws Error if the source cannot be rewound
void look_again(FrameSource& source, std::span<const FusedFrame> fused, GhostRevision& revision,
                StaticMap& map, StageTimes& times, const GhostProgress& progress = {});

}  // namespace roomradar
