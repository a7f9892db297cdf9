// ghost_zone.hpp: the space around removed voxels in which samples are erased and measured again.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <bitset>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapping/revision/ghosts.hpp"

namespace roomradar {

/// All cells of 4^3 voxels with a removed voxel, and the neighbours of these cells. Removed voxels are ghosts
/// (a frame saw through them) and absent voxels (parts of departed objects without measured depth behind
/// them); see GhostVotes::Verdicts. The zone extends at least four voxels around each removed voxel. With 1
/// cm voxels, this is at least the half-width of a Kinect's truncation band for surfaces measured from up to
/// 3.1 m.
class GhostZone {
 public:
  GhostZone(const GhostVotes::Verdicts& verdicts, double resolution_m);

  /// Returns the action for a voxel. Ghosts become free, absent voxels become unknown. Other samples of the
  /// zone are erased so they can be measured again. Exception: samples at surface of an earlier scan that no
  /// frame measures are kept if they are farther than two voxels from removed voxels. An occupied voxel
  /// without a sample becomes unknown if a ghost or absent voxel, but no remaining surface, is within two
  /// voxels.
  [[nodiscard]] SampleAction fate_of(const SurfaceSample& sample) const;
  /// Returns true if the voxel is at most two voxels from a brick that the zone overlaps or touches.
  [[nodiscard]] bool reaches(const VoxelIndex& voxel) const;
  /// Returns true if the zone overlaps or touches the brick or one of its 26 neighbours. If false, reaches()
  /// is false for all voxels of the brick.
  /// @param first  the brick's minimum-corner voxel
  [[nodiscard]] bool touches(const VoxelIndex& first) const;
  /// Returns true if any part of the zone may be in the camera's image.
  [[nodiscard]] bool in_view(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera) const;

  /// Keeps pixels whose ray ends within two voxels of remaining surface near the zone, but not within two
  /// voxels of a removed voxel. Sets the depth of all other pixels to 0. The kept pixels measure the zone's
  /// erased samples.
  void mask(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m) const;

 private:
  // Set of voxels of a brick: bit x + 8 y of plane z.
  struct VoxelBits {
    std::array<std::uint64_t, 8> planes{};
    void set(std::size_t offset) { planes[offset / 64] |= std::uint64_t{1} << offset % 64; }
    [[nodiscard]] bool test(std::size_t offset) const {
      return (planes[offset / 64] >> offset % 64 & 1U) != 0;
    }
  };
  using BitsOfBricks = std::unordered_map<std::uint64_t, VoxelBits>;  // by the brick's key
  static BitsOfBricks bits_of(std::initializer_list<std::span<const VoxelIndex>> sets);
  // Returns the brick's voxels that are at most two voxels from one of the set.
  static VoxelBits near_in_brick(const VoxelIndex& first, const BitsOfBricks& set);
  struct Marks {
    std::bitset<8> cells;        // which of a brick's 2^3 cells are in the zone
    std::bitset<8> ghost_cells;  // which of these contain a ghost
    VoxelBits ghost;
    VoxelBits absent;
    VoxelBits near_ghost;
    VoxelBits near_still;
    VoxelBits unseen;
    VoxelBits near_unseen;
  };
  [[nodiscard]] const Marks* marks_of(const VoxelIndex& voxel) const;

  double resolution_m_;
  std::unordered_map<std::uint64_t, Marks> marks_;  // bricks with removed voxels, and their neighbours
  std::vector<VoxelIndex> bricks_;                  // their minimum-corner voxels
};

}  // namespace roomradar
