// static_map.hpp: the static room as an octree: occupied, free or unknown, and distances near surfaces.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "mapping/octree/fusion_config.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class Occupancy { kUnknown, kFree, kOccupied };

enum class FuseStatus {
  kFused,
  kNothingMeasured,  ///< no pixel holds a depth; the map is as it was
  /// depth image and depth camera disagree in size, or have more than 4,096 pixels a side, or the camera
  /// cannot be one; not fused
  kInvalidFrame,
  kInvalidPose,  ///< not finite, or not a rotation; not fused
  kOutOfReach,   ///< the frame reaches past the octree's 16-bit keys (reach_m()); not fused
};
std::string_view to_string(FuseStatus status);

/// Where a voxel stands in the octree: its lower corner is at index * resolution_m in the world.
using VoxelIndex = Eigen::Vector3i;

/// What the frames said about the surface near one voxel's centre.
struct SurfaceSample {
  VoxelIndex voxel = VoxelIndex::Zero();
  Occupancy occupancy = Occupancy::kUnknown;
  float distance_m = 0.0F;  ///< signed, along the viewing axis; > 0 on the free side
  float weight = 0.0F;      ///< sum of (sigma at 1 m / sigma)^2 over the frames, capped
  Rgb colour{};
  bool has_colour = false;
};

/// A leaf of the octree, of any size: a cube of one answer.
struct MapLeaf {
  VoxelIndex lowest_voxel = VoxelIndex::Zero();  ///< each coordinate a multiple of edge_voxels
  int edge_voxels = 1;                           ///< a power of two
  float log_odds = 0.0F;                         ///< of being occupied: > 0 occupied, < 0 free, 0 unknown
};

/// What becomes of a sample when the map is revised.
enum class SampleFate {
  kKeep,
  kForget,   ///< its signed distance and colour go; whether it is occupied stays
  kFree,     ///< it goes, and the voxel becomes as free as it can be
  kUnknown,  ///< it goes, and what is known of the voxel
};

struct MapCounts {
  std::size_t occupied_leaves = 0;
  std::size_t free_leaves = 0;
  std::size_t sampled_leaves = 0;  ///< finest leaves with a signed distance, of any occupancy
  std::size_t nodes = 0;
  std::size_t memory_bytes = 0;     ///< of the blocks that the nodes lie in; the map alone decides it
  Eigen::AlignedBox3d known_world;  ///< of all free and occupied leaves; empty if there are none
  Eigen::AlignedBox3d occupied_world;
};

/// The octree. At resolution r it reaches +-32768 r from the world's origin (1 cm: +-327 m). Not thread safe
/// while fusing; concurrent const calls are.
class StaticMap {
 public:
  /// Throws Error if resolution_m is not within 0.001..1 m or the config is out of its rules.
  explicit StaticMap(double resolution_m, const FusionConfig& config = {});
  ~StaticMap();
  StaticMap(StaticMap&&) noexcept;
  StaticMap& operator=(StaticMap&&) noexcept;

  /// Adds what one frame proves. depth_m of depth_camera's size; the colour image is used where there is one.
  /// T_world_camera: pose of the depth camera. Nothing changes unless the answer is kFused.
  FuseStatus fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// kUnknown for whatever no ray has crossed, also past the octree's reach and for NaN.
  [[nodiscard]] Occupancy occupancy_at(const Eigen::Vector3d& p_world) const;
  /// The sample of the voxel that holds p_world, if it has one.
  [[nodiscard]] std::optional<SurfaceSample> sample_at(const Eigen::Vector3d& p_world) const;
  /// Calls `visit` for each voxel that holds a signed distance, in Morton order (deterministic).
  void visit_samples(const std::function<void(const SurfaceSample&)>& visit) const;

  /// The same for the voxels whose centre lies in a box.
  void visit_samples(const Eigen::AlignedBox3d& box_world,
                     const std::function<void(const SurfaceSample&)>& visit) const;

  /// Calls `visit` for each free or occupied leaf, as large as it is stored, in Morton order (deterministic).
  void visit_leaves(const std::function<void(const MapLeaf&)>& visit) const;

  /// Adds what another map of this resolution knows: its log-odds to all voxels of the cube, clamped as for
  /// frames. Throws Error if the cube is none of the octree's or the log-odds are not finite.
  void add_evidence(const MapLeaf& leaf);
  /// The same for a voxel's signed distance and colour, weighted as measured; its occupancy is not looked at.
  /// Throws Error if the voxel is past the octree's reach, or a number is not finite or the weight not > 0.
  void add_evidence(const SurfaceSample& sample);

  /// Asks for the fate of each voxel with a signed distance, or occupied without (weight 0), in that order.
  void revise_samples(const std::function<SampleFate(const SurfaceSample&)>& decide);
  /// The same for the voxels whose centre lies in a box.
  void revise_samples(const Eigen::AlignedBox3d& box_world,
                      const std::function<SampleFate(const SurfaceSample&)>& decide);

  [[nodiscard]] double resolution_m() const;
  /// Half the edge of the cube around the world's origin that voxels can exist in, m.
  [[nodiscard]] double reach_m() const;
  [[nodiscard]] const FusionConfig& config() const;
  /// Of the octree's nodes; at once, so that a cap can be kept after each frame.
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Walks the whole tree: some 20 ms a million nodes.
  [[nodiscard]] MapCounts counts() const;

  /// Everything, in OctoMap's .ot form with the tree type "RoomRadarOcTree". Throws Error if the file cannot
  /// be written. What no sensor sees is not read again: one free cube of more than 8,192 voxels' edge, or one
  /// solid cube of more than 4 m.
  void write_ot(const std::filesystem::path& path) const;
  /// Occupied and free only, as OctoMap's plain OcTree in .bt form, which octovis opens. Throws Error
  /// likewise.
  void write_bt(const std::filesystem::path& path) const;
  /// Reads what write_ot wrote. The file is not trusted: form, depth, sizes and numbers are checked while it
  /// is read. Throws Error naming the file and the fault.
  static StaticMap read_ot(const std::filesystem::path& path, const FusionConfig& config = {});

 private:
  struct Octree;  // keeps OctoMap out of this header
  explicit StaticMap(std::unique_ptr<Octree> octree);
  std::unique_ptr<Octree> octree_;
};

}  // namespace roomradar
