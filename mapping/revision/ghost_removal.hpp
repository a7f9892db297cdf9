// ghost_removal.hpp: removes ghosts (surface of objects that moved during the scan) from the static map.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "mapping/revision/chosen_frames.hpp"
#include "mapping/revision/ghosts.hpp"

namespace roomradar {

/// Voxels removed from the map, and the progress of refuse_surroundings() around them.
struct GhostRevision {
  GhostVotes::Verdicts verdicts;  ///< `still` and `unseen` contain only voxels near removed ones
  std::uint64_t next = 0;  ///< index of the first fused frame that refuse_surroundings() has not processed

  [[nodiscard]] std::int64_t voxels() const {
    return static_cast<std::int64_t>(verdicts.ghosts.size() + verdicts.absent.size());
  }
};

/// Called after each processed frame.
using GhostProgress = std::function<void(const std::string& note)>;

/// Reads the source again and removes departed objects from the map. Surface that frames see through becomes
/// free. Departed surface without measured depth behind it becomes unknown. Signed distances around both are
/// erased. Stages timed: read, ghosts (per frame).
///
/// @throws Error if the source cannot be rewound or the config is invalid
GhostRevision remove_ghosts(FrameSource& source, std::span<const FusedFrame> fused, const GhostConfig& config,
                            StaticMap& map, StageTimes& times, const GhostProgress& progress = {});

/// Fuses the surroundings of the removed voxels again, from frames with different views, starting with frame
/// revision.next. Leaves out pixels that measured the departed objects: such measurements had biased the
/// signed distances of the surface behind the objects. Between frames, e.g. in calls of `progress`, `map` and
/// `revision` are the complete state for resuming. Reads no frame if no voxel was removed.
///
/// @throws Error if the source cannot be rewound
void refuse_surroundings(FrameSource& source, std::span<const FusedFrame> fused, GhostRevision& revision,
                         StaticMap& map, StageTimes& times, const GhostProgress& progress = {});

}  // namespace roomradar
