// ghosts.hpp: which parts of the static map are of things that moved on: what is static is never seen
// through.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/revision/depth_windows.hpp"
#include "mapping/revision/unmeasured_evidence.hpp"

namespace roomradar {

struct GhostConfig {
  /// A sample is seen through where the measured depth is greater than its own by this much, and by this many
  /// standard deviations of the measurement: noise and tracking errors are less.
  float margin_m = 0.03F;
  float margin_sigmas = 4.0F;
  /// And by this more a metre of depth: a pose that is off by 1.7 degrees shifts a slanted surface by so
  /// much, and sensors other than the Kinect are noisier far away.
  float margin_per_m = 0.03F;
  /// And by so many edges of the map's cells: what is measured lies up to one before or behind a sample.
  float margin_voxels = 1.5F;
  /// ... in every pixel of a window of this radius at the sample's depth, so that a pose that is a little off
  /// does not see past the edges of static things.
  float window_radius_m = 0.03F;
  float min_measured_share = 0.5F;  ///< of the window's pixels must have depth, the middle one always
  int min_through = 3;              ///< so many frames must see through a sample
  float min_through_share = 0.1F;   ///< and so many of those that see it or see through it
  /// Samples seen through that hang together are a ghost if they cover a square of this edge, at two samples
  /// for each face of a voxel; fewer are tracking errors at the edges of static things.
  float min_extent_m = 0.15F;
  int max_looks = 170;  ///< frames looked at, spread over the recording
};

/// Throws Error naming field, value and rule.
void require_valid(const GhostConfig& config);

/// Counts, for each voxel of the map that holds surface, how many frames see it and how many see through it.
/// A hand that rested on the table for half of the recording is as well measured as the table; that the table
/// is seen through it in the other half tells it from what is static. Frames without depth there count as
/// AbsenceVotes.
class GhostVotes {
 public:
  /// Takes the map's surface as it is now: samples within a voxel of the surface, and occupied ones. Throws
  /// Error if the config is out of its rules.
  explicit GhostVotes(const StaticMap& map, const GhostConfig& config = {});

  /// Adds one frame's votes. The frame is one that was fused at this pose.
  void look(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// What moved on are voxels with enough evidence that are enough together, and what hangs together with
  /// them on less: little round a small group, more round one that is too large to be an error of tracking.
  struct Verdicts {
    std::vector<VoxelIndex> ghosts;  ///< of that, what is seen through
    std::vector<VoxelIndex> absent;  ///< of that, what is gone with nothing measured behind
    std::vector<VoxelIndex> still;   ///< other surface that is occupied, and was looked at
    std::vector<VoxelIndex> unseen;  ///< surface that no look measured, or saw through: of an earlier scan
  };
  /// Each in the octree's order.
  [[nodiscard]] Verdicts verdicts() const;

 private:
  enum class Fate : std::uint8_t { kStill, kGhost, kAbsent };
  [[nodiscard]] std::vector<Fate> fates() const;  // in the votes' order
  struct Votes {
    std::uint16_t offset : 9 = 0;  // in its brick
    std::uint16_t occupied : 1 = 0;
    std::uint16_t seen = 0;
    std::uint16_t through = 0;
    std::uint16_t glimpsed = 0;  // its own pixel sees through it, but not all of the window
  };
  struct Brick {
    VoxelIndex first = VoxelIndex::Zero();
    std::size_t end = 0;  // of its votes; they begin where those of the brick before end
  };
  // Whether so many of all of them are min_through_share or more, and one at least.
  [[nodiscard]] bool is_share(int part, int others) const;

  double resolution_m_;
  GhostConfig config_;
  std::vector<Brick> bricks_;
  std::vector<Votes> votes_;
  std::vector<AbsenceVotes> absence_;  // in the same order
  AbsenceLooks absence_looks_;
  DepthWindows windows_;
};

}  // namespace roomradar
