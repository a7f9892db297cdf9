// ghosts.hpp: finds ghosts in the static map: surface of objects that moved away during the scan.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/revision/depth_windows.hpp"
#include "mapping/revision/unmeasured_evidence.hpp"

namespace roomradar {

struct GhostConfig {
  /// A sample is seen through if the measured depth exceeds the sample's by more than the largest of four
  /// margins. The first two (metres, and standard deviations of depth) cover noise and tracking errors.
  float margin_m = 0.03F;
  float margin_sigmas = 4.0F;
  /// Margin per metre of depth: a pose error of 1.7 degrees shifts a slanted surface this much, and sensors
  /// other than the Kinect are noisier at long range.
  float margin_per_m = 0.03F;
  /// Margin in voxels: samples are up to one voxel in front of or behind the measured surface.
  float margin_voxels = 1.5F;
  /// Radius, at the sample's depth, of the window in which every pixel must see through it. Otherwise small
  /// pose errors would let rays pass the edges of static objects.
  float window_radius_m = 0.03F;
  float min_measured_share = 0.5F;  ///< fraction of the window's pixels that must have depth; the centre
                                    ///< always must
  int min_through = 3;              ///< min frames that see through a ghost's sample
  float min_through_share = 0.1F;   ///< min fraction of these among frames that see it or see through it
  /// A connected group of seen-through samples is a ghost if it covers a square of this edge, at two samples
  /// per voxel face. Smaller groups are tracking errors at the edges of static objects.
  float min_extent_m = 0.15F;
  int max_looks = 170;  ///< max frames used, spread over the recording
};

/// Throws Error naming field, value and rule if a setting is out of range.
void require_valid(const GhostConfig& config);

/// Counts, for each surface voxel of the map, the frames that see it and the frames that see through it. A
/// hand that rested on the table for half of the recording is measured as well as the table; only frames that
/// see the table through it distinguish it from static surface. Frames without depth there count as
/// AbsenceVotes.
class GhostVotes {
 public:
  /// Copies the map's current surface: samples within a voxel of the surface, and occupied ones. Throws Error
  /// if the config is invalid.
  explicit GhostVotes(const StaticMap& map, const GhostConfig& config = {});

  /// Adds one frame's votes; the frame must have been fused at this pose.
  void look(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Departed objects are large enough groups of voxels with enough evidence, plus connected voxels with
  /// weaker evidence. The latter extend little around small groups, and more around groups too large to be
  /// tracking errors.
  struct Verdicts {
    std::vector<VoxelIndex> ghosts;  ///< voxels of departed objects that are seen through
    std::vector<VoxelIndex> absent;  ///< voxels of departed objects with nothing measured behind
    std::vector<VoxelIndex> still;   ///< other occupied surface that a frame observed
    std::vector<VoxelIndex> unseen;  ///< surface of an earlier scan, which no frame measured or saw through
  };
  /// Classifies all voxels; each list is in the octree's order.
  [[nodiscard]] Verdicts verdicts() const;

 private:
  enum class Fate : std::uint8_t { kStill, kGhost, kAbsent };
  [[nodiscard]] std::vector<Fate> fates() const;  // in the order of votes_
  struct Votes {
    std::uint16_t offset : 9 = 0;  // index in its brick
    std::uint16_t occupied : 1 = 0;
    std::uint16_t seen = 0;
    std::uint16_t through = 0;
    std::uint16_t glimpsed = 0;  // frames whose centre pixel sees through it, but not the whole window
  };
  struct Brick {
    VoxelIndex first = VoxelIndex::Zero();
    std::size_t end = 0;  // end of its votes; they begin at the end of the previous brick's
  };
  // True if `part` > 0 and at least min_through_share of part + others.
  [[nodiscard]] bool is_share(int part, int others) const;

  double resolution_m_;
  GhostConfig config_;
  std::vector<Brick> bricks_;
  std::vector<Votes> votes_;
  std::vector<AbsenceVotes> absence_;  // in the order of votes_
  AbsenceVoter absence_looks_;
  DepthWindows windows_;
};

}  // namespace roomradar
