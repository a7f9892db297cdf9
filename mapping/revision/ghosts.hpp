// ghosts.hpp: finds ghosts (surface of objects that moved away during the scan) in the static map.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/revision/brick_projection.hpp"
#include "mapping/revision/depth_windows.hpp"
#include "mapping/revision/ghost_config.hpp"
#include "mapping/revision/unmeasured_evidence.hpp"

namespace roomradar {

/// For each surface cell of the map, counts the frames that measure it and the frames that see through it.
/// Example: a hand that rests on a table for half of the recording is measured in as many frames as the
/// table. Only frames that measure the table behind the hand's voxels distinguish the hand from static
/// surface. Frames without depth at the cell are counted in AbsenceVotes. All eight voxels of a coarse cell
/// get the same verdict.
class GhostVotes {
 public:
  /// Copies the map's surface cells. A surface cell has a sample, and is occupied or has a signed distance of
  /// at most one voxel. Throws Error if the config is invalid.
  explicit GhostVotes(const StaticMap& map, const GhostConfig& config = {});

  /// Adds one frame's votes. The frame must have been fused at this pose.
  void look(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Classification of the surface voxels. A departed object is a large enough connected component of voxels
  /// with enough evidence, plus connected voxels with weaker evidence. If the latter are more than half, only
  /// the voxels that enough frames see through are removed. Components of at least 0.5 x 0.5 m are too large
  /// to be tracking errors. Up to 20 cm around them, even weaker evidence suffices.
  struct Verdicts {
    std::vector<VoxelIndex> ghosts;  ///< voxels of departed objects through which frames see
    std::vector<VoxelIndex> absent;  ///< voxels of departed objects without measured depth behind
    /// Other occupied surface that a frame observed, within GhostZone::reaches() of the zone of `ghosts` and
    /// `absent`.
    std::vector<VoxelIndex> still;
    /// Surface of an earlier scan that no frame measured or saw through, within reaches() of the same zone.
    std::vector<VoxelIndex> unseen;
  };
  /// Classifies the voxels. Each list is in Morton order.
  [[nodiscard]] Verdicts verdicts() const;

 private:
  enum class Fate : std::uint8_t { kStill, kGhost, kAbsent };
  [[nodiscard]] std::vector<Fate> fates() const;  // in the order of votes_
  struct Votes {
    std::uint16_t offset : 9 = 0;  // of the lowest voxel in the brick
    std::uint16_t coarse : 1 = 0;
    std::uint16_t occupied : 1 = 0;
    std::uint16_t seen = 0;
    std::uint16_t through = 0;
    // Number of frames that see through the voxel in its pixel, but not in the whole window.
    std::uint16_t glimpsed = 0;
  };
  // Calls visit(voxel, index in votes_) for each voxel of a brick's surface cells, in Morton order.
  template <typename Visit>
  void for_each_voxel_of(const CellBrick& brick, const Visit& visit) const;
  // As for_each_voxel_of(), of all bricks.
  template <typename Visit>
  void for_each_voxel(const Visit& visit) const;
  // Returns the voxels for which are_such(votes, absence votes) is true.
  template <typename AreSuch>
  [[nodiscard]] std::vector<VotedVoxel> those(const AreSuch& are_such) const;
  // Returns true if `part` > 0 and at least min_through_share of part + others.
  [[nodiscard]] bool is_share(int part, int others) const;

  double resolution_m_;
  GhostConfig config_;
  std::vector<CellBrick> bricks_;
  std::vector<Votes> votes_;
  std::vector<AbsenceVotes> absence_;  // in the order of votes_
  AbsenceVoter absence_looks_;
  DepthWindows windows_;
};

}  // namespace roomradar
