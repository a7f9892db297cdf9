// ghost_zone.hpp: the space around ghosts, in which samples are erased and measured again.
#pragma once
#include <Eigen/Geometry>
#include <bitset>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapping/revision/ghosts.hpp"

namespace roomradar {

/// All cells of 4^3 voxels that contain a ghost, and their neighbours. The zone extends at least four voxels
/// around each ghost, as far as signed distance is kept from a surface at up to 2.5 m.
class GhostZone {
 public:
  GhostZone(const GhostVotes::Verdicts& verdicts, double resolution_m);

  /// Ghosts become free, absent voxels unknown. Other samples of the zone are erased to be measured again,
  /// except on surface that no frame would measure. An occupied voxel without a sample has no votes: within
  /// two voxels of a ghost it becomes unknown, unless surface that remains is also within two voxels.
  [[nodiscard]] SampleAction fate_of(const SurfaceSample& sample) const;
  /// True if a voxel is near enough to affect the zone.
  [[nodiscard]] bool reaches(const VoxelIndex& voxel) const;
  /// True if any part of the zone may be in the camera's image.
  [[nodiscard]] bool in_view(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) const;

  /// Keeps depth only in pixels that end within two voxels of remaining surface near the zone and not within
  /// two voxels of a ghost; other pixels carry no information on the zone's samples.
  void mask(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m) const;

 private:
  struct Marks {
    std::bitset<8> cells;        // which of its 2^3 cells are in the zone
    std::bitset<8> ghost_cells;  // which of these contain a ghost
    std::bitset<512> ghost;
    std::bitset<512> absent;
    std::bitset<512> near_ghost;
    std::bitset<512> near_still;
    std::bitset<512> unseen;
    std::bitset<512> near_unseen;
  };
  [[nodiscard]] const Marks* marks_of(const VoxelIndex& voxel) const;

  double resolution_m_;
  std::unordered_map<std::uint64_t, Marks> marks_;  // by brick: those that contain a ghost, and their
                                                    // neighbours
  std::vector<VoxelIndex> bricks_;                  // their lowest voxels
};

}  // namespace roomradar
