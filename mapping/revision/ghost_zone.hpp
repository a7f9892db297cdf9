// ghost_zone.hpp: the space round ghosts, and what frames say about it without the things that left them.
#pragma once
#include <Eigen/Geometry>
#include <bitset>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapping/revision/ghosts.hpp"

namespace roomradar {

/// All cells of 4^3 voxels that hold a ghost, and their neighbours: four voxels round each ghost and more,
/// which is as far as signed distance is kept from a surface at up to 2.5 m.
class GhostZone {
 public:
  GhostZone(const GhostVotes::Verdicts& verdicts, double resolution_m);

  /// Free where it is seen through, unknown where it is absent, and the zone's other samples are measured
  /// anew, but for those of surface that no frame would measure. An occupied voxel without a sample, which no
  /// look tells anything of, is unknown beside what moved on unless it is as near to what is still there.
  [[nodiscard]] SampleFate fate_of(const SurfaceSample& sample) const;
  /// Whether a voxel is so near that what it is may matter to the zone.
  [[nodiscard]] bool reaches(const VoxelIndex& voxel) const;
  /// Whether any of the zone may be in the camera's image.
  [[nodiscard]] bool in_view(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) const;

  /// Leaves depth only in pixels that end near the zone, at surface that is still there and not at a ghost,
  /// both within two voxels: the others do not tell what the zone's samples are.
  void mask(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m) const;

 private:
  struct Marks {
    std::bitset<8> cells;        // of its 2^3 cells, those in the zone
    std::bitset<8> ghost_cells;  // ... and those that hold a ghost
    std::bitset<512> ghost;
    std::bitset<512> absent;
    std::bitset<512> near_ghost;
    std::bitset<512> near_still;
    std::bitset<512> unseen;
    std::bitset<512> near_unseen;
  };
  [[nodiscard]] const Marks* marks_of(const VoxelIndex& voxel) const;

  double resolution_m_;
  std::unordered_map<std::uint64_t, Marks> marks_;  // of the bricks that hold a ghost, and their neighbours
  std::vector<VoxelIndex> bricks_;                  // their lowest voxels
};

}  // namespace roomradar
