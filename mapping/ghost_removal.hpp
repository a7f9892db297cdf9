// ghost_removal.hpp: takes out of the static map what moved on while the room was scanned.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "mapping/ghosts.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/stage_times.hpp"

namespace roomradar {

/// A frame that was fused, and where to find it again.
struct FusedFrame {
  std::int64_t position = 0;  ///< in the source: how many reads come before its own
  std::int64_t frame_index = 0;
  Intrinsics depth_camera;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Reads the source again to find the surface that frames see through, which becomes free, and what is gone
/// with nothing measured behind, which becomes unknown; and fuses anew what lies round them: without the
/// pixels that saw the ghosts, as they pulled the real surface behind towards them. Stages timed: read,
/// ghosts (of one frame). `progress` is called after each frame.
///
/// @return how many voxels were ghosts
/// @throws Error if the source cannot be rewound or the config is out of its rules
std::int64_t remove_ghosts(FrameSource& source, std::span<const FusedFrame> fused, const GhostConfig& config,
                           StaticMap& map, StageTimes& times,
                           const std::function<void(const std::string& note)>& progress = {});

}  // namespace roomradar
