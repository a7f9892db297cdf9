// static_map.hpp: octree of the static room: occupied, free or unknown, with signed distance near surfaces.
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
  kNothingMeasured,  ///< no pixel has depth; map unchanged
  /// sizes of depth image and depth camera differ or exceed 4,096 pixels a side, or the camera is invalid;
  /// map unchanged
  kInvalidFrame,
  kInvalidPose,  ///< not finite or not rigid; map unchanged
  kOutOfBounds,  ///< a ray ends outside the octree's 16-bit keys (reach_m()); map unchanged
};
std::string_view to_string(FuseStatus status);

/// Integer voxel coordinates: the voxel's lower corner is at index * resolution_m in the world.
using VoxelIndex = Eigen::Vector3i;

/// Fused measurement of the surface near one voxel's centre.
struct SurfaceSample {
  VoxelIndex voxel = VoxelIndex::Zero();
  Occupancy occupancy = Occupancy::kUnknown;
  float distance_m = 0.0F;  ///< signed, along the viewing axis; > 0 on the free side
  float weight = 0.0F;      ///< sum of (sigma at 1 m / sigma)^2 over the frames, capped
  Rgb colour{};
  bool has_colour = false;
};

/// A leaf of the octree, of any size: a cube of uniform occupancy.
struct MapLeaf {
  VoxelIndex lowest_voxel = VoxelIndex::Zero();  ///< each coordinate a multiple of edge_voxels
  int edge_voxels = 1;                           ///< a power of two
  float log_odds = 0.0F;                         ///< > 0 occupied, < 0 free, 0 unknown
};

/// Action on a sample when the map is revised.
enum class SampleAction {
  kKeep,
  kEraseSample,  ///< signed distance and colour erased, occupancy kept
  kFree,         ///< sample erased, voxel set to the minimum log-odds
  kUnknown,      ///< sample erased, voxel reset to unknown
};

struct MapCounts {
  std::size_t occupied_leaves = 0;
  std::size_t free_leaves = 0;
  std::size_t sampled_leaves = 0;  ///< finest leaves with a signed distance, of any occupancy
  std::size_t nodes = 0;
  std::size_t memory_bytes = 0;     ///< blocks in use; depends on the map's content only
  Eigen::AlignedBox3d known_world;  ///< bounds of all free and occupied leaves; empty if none
  Eigen::AlignedBox3d occupied_world;
};

/// The static room's octree. At resolution r it covers +-32768 r around the world's origin (1 cm: +-327 m).
/// Concurrent const calls are thread safe; calls that change the map need exclusive access.
class StaticMap {
 public:
  /// Throws Error if resolution_m is not within 0.001..1 m or the config is invalid.
  explicit StaticMap(double resolution_m, const FusionConfig& config = {});
  ~StaticMap();
  StaticMap(StaticMap&&) noexcept;
  StaticMap& operator=(StaticMap&&) noexcept;

  /// Fuses one frame, with its colour image if present. T_world_camera is the pose of the depth camera.
  /// Leaves the map unchanged unless it returns kFused.
  FuseStatus fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Returns kUnknown for voxels that no ray has crossed, points outside the octree, and NaN.
  [[nodiscard]] Occupancy occupancy_at(const Eigen::Vector3d& p_world) const;
  /// Sample of the voxel that contains p_world; nullopt if it has none.
  [[nodiscard]] std::optional<SurfaceSample> sample_at(const Eigen::Vector3d& p_world) const;
  /// Calls `visit` for each voxel with a signed distance, in Morton order (deterministic).
  void visit_samples(const std::function<void(const SurfaceSample&)>& visit) const;

  /// As above, only for voxels whose centre is in the box.
  void visit_samples(const Eigen::AlignedBox3d& box_world,
                     const std::function<void(const SurfaceSample&)>& visit) const;

  /// Calls `visit` for each free or occupied leaf, at its stored size, in Morton order (deterministic).
  void visit_leaves(const std::function<void(const MapLeaf&)>& visit) const;

  /// Adds log-odds from another map of the same resolution to all voxels of the cube, clamped as in fuse().
  /// Throws Error if the cube is not a valid octree node or the log-odds are not finite.
  void add_evidence(const MapLeaf& leaf);
  /// Averages in a voxel's signed distance and colour by weight; ignores its occupancy. Throws Error if the
  /// voxel is outside the octree, the distance or weight is not finite, or the weight is not > 0.
  void add_evidence(const SurfaceSample& sample);

  /// Calls `decide` for each voxel that has a signed distance or is occupied without one (weight 0), in
  /// Morton order, and applies the result. Skips pruned nodes, which have no samples.
  void revise_samples(const std::function<SampleAction(const SurfaceSample&)>& decide);
  /// As above, only for voxels whose centre is in the box.
  void revise_samples(const Eigen::AlignedBox3d& box_world,
                      const std::function<SampleAction(const SurfaceSample&)>& decide);

  [[nodiscard]] double resolution_m() const;
  /// Half the edge of the cube around the world's origin that the octree covers, m.
  [[nodiscard]] double reach_m() const;
  [[nodiscard]] const FusionConfig& config() const;
  /// Node memory; O(1), so a cap can be enforced every frame.
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Walks the whole tree: about 20 ms per million nodes.
  [[nodiscard]] MapCounts counts() const;

  /// Writes the complete map in OctoMap's .ot format with tree type "RoomRadarOcTree". Throws Error if the
  /// file cannot be written. read_ot() rejects cubes that no sensor produces: free ones with an edge above
  /// 8,192 voxels, solid ones above 4 m.
  void write_ot(const std::filesystem::path& path) const;
  /// Writes free and occupied only, as OctoMap's plain OcTree in .bt format, which octovis opens. Throws
  /// Error if the file cannot be written.
  void write_bt(const std::filesystem::path& path) const;
  /// Reads a file from write_ot(). The file is not trusted: form, depth, sizes and numbers are checked while
  /// it is read. Throws Error naming the file and the fault.
  static StaticMap read_ot(const std::filesystem::path& path, const FusionConfig& config = {});

 private:
  struct Octree;  // defined in static_map_octree.hpp
  explicit StaticMap(std::unique_ptr<Octree> octree);
  std::unique_ptr<Octree> octree_;
};

}  // namespace roomradar
