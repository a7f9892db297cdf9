// static_map.hpp: octree of the static room, with occupancy (occupied, free, unknown) and, near surfaces,
// signed distance.
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

enum class Occupancy : std::uint8_t { kUnknown, kFree, kOccupied };

enum class FuseStatus {
  kFused,
  kNothingMeasured,  ///< no pixel has depth; map unchanged
  /// Invalid camera, or a depth image that differs in size from its camera or exceeds 4,096 pixels per side.
  /// Map unchanged.
  kInvalidFrame,
  kInvalidPose,  ///< pose not finite or not rigid; map unchanged
  kOutOfBounds,  ///< a ray ends outside the octree (see reach_m()); map unchanged
};
std::string_view to_string(FuseStatus status);

struct PreparedFrame;  // see prepared_frame.hpp

/// Integer voxel coordinates. The lower corner of voxel `index` is at index * resolution_m in the world
/// frame.
using VoxelIndex = Eigen::Vector3i;

/// Fused measurements of the surface near one voxel's centre.
struct SurfaceSample {
  VoxelIndex voxel = VoxelIndex::Zero();
  Occupancy occupancy = Occupancy::kUnknown;
  /// Signed distance from the voxel's centre to the surface along the viewing axis, m; > 0 on the free side.
  float distance_m = 0.0F;
  float weight = 0.0F;  ///< sum of weight_at() (at most 1 each) over the fused frames, capped
  Rgb colour{};
  bool has_colour = false;
};

/// A leaf of the octree: a cube of uniform occupancy, one voxel or larger.
struct MapLeaf {
  VoxelIndex lowest_voxel = VoxelIndex::Zero();  ///< lower corner; each coordinate is a multiple of
                                                 ///< edge_voxels
  int edge_voxels = 1;                           ///< edge length in voxels, a power of two
  float log_odds = 0.0F;                         ///< > 0: occupied; < 0: free; 0: unknown
};

/// Action of revise_samples() on a voxel and its sample (signed distance and colour).
enum class SampleAction {
  kKeep,
  kEraseSample,  ///< sample erased, occupancy kept
  kFree,         ///< sample erased, voxel set to the minimum log-odds
  kUnknown,      ///< sample erased, voxel reset to unknown
};

struct MapCounts {
  std::size_t occupied_leaves = 0;
  std::size_t free_leaves = 0;
  std::size_t sampled_leaves = 0;  ///< number of voxels with a signed distance, of any occupancy
  std::size_t nodes = 0;
  std::size_t memory_bytes = 0;     ///< memory of the blocks in use; depends only on the map's content
  Eigen::AlignedBox3d known_world;  ///< bounding box of all free and occupied leaves, m; empty if none
  Eigen::AlignedBox3d occupied_world;
};

/// Octree of occupancy and signed distances. With resolution r, it covers +-32768 r around the origin of the
/// world frame (+-327 m at 1 cm). Concurrent const calls are thread safe. Calls that change the map need
/// exclusive access.
class StaticMap {
 public:
  /// Creates an empty map. Throws Error if resolution_m is not within 0.001..1 m or the config is invalid.
  explicit StaticMap(double resolution_m, const FusionConfig& config = {});
  ~StaticMap();
  StaticMap(StaticMap&&) noexcept;
  StaticMap& operator=(StaticMap&&) noexcept;

  /// Fuses one frame, including its colour image if it has one. T_world_camera is the pose of the depth
  /// camera. The map changes only if the return value is kFused.
  FuseStatus fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Computes the part of fuse() that does not depend on the map's content, on the caller's thread. Another
  /// frame may be fused meanwhile.
  void prepare(const Frame& frame, const Eigen::Isometry3d& T_world_camera, PreparedFrame& prepared) const;
  /// Does the rest of fuse(). `frame` must be the frame for which this map, or another one with the same
  /// resolution and config, prepared `prepared`.
  FuseStatus fuse(const Frame& frame, const PreparedFrame& prepared);

  /// Returns the occupancy of the voxel that contains p_world. Returns kUnknown if no ray has crossed or
  /// ended in the voxel, or if p_world is outside the octree or NaN.
  [[nodiscard]] Occupancy occupancy_at(const Eigen::Vector3d& p_world) const;
  /// Returns the sample of the voxel that contains p_world; nullopt if the voxel has no sample.
  [[nodiscard]] std::optional<SurfaceSample> sample_at(const Eigen::Vector3d& p_world) const;
  /// Calls `visit` for each voxel with a signed distance, in Morton order (deterministic).
  void visit_samples(const std::function<void(const SurfaceSample&)>& visit) const;

  /// Calls `visit` for each voxel with a signed distance whose centre is in the box, in Morton order.
  void visit_samples(const Eigen::AlignedBox3d& box_world,
                     const std::function<void(const SurfaceSample&)>& visit) const;

  /// Calls visit(sample, edge_voxels) for each cell with a signed distance that has a voxel in the box, in
  /// Morton order. The edge of a cell is 1 or 2 voxels. SurfaceSample::voxel is the cell's lowest voxel, and
  /// distance_m is at the cell's centre.
  void visit_cells(const Eigen::AlignedBox3d& box_world,
                   const std::function<void(const SurfaceSample&, int)>& visit) const;

  /// Calls `visit` for each free or occupied leaf, at its stored size, in Morton order (deterministic).
  void visit_leaves(const std::function<void(const MapLeaf&)>& visit) const;

  /// Adds the log-odds of a leaf of another map to all voxels of the leaf's cube, clamped as in fuse(). The
  /// other map must have the same resolution. Throws Error if the cube is not a valid octree node or the
  /// log-odds are not finite.
  void add_evidence(const MapLeaf& leaf);
  /// Merges another map's sample into the voxel's own sample: weighted means of signed distance and colour.
  /// The given sample's occupancy is ignored. Throws Error if the voxel is outside the octree, the distance
  /// or weight is not finite, or the weight is not > 0.
  void add_evidence(const SurfaceSample& sample);

  /// Adds all log-odds and samples of another map of the same resolution, in the same world frame. Coarse
  /// cells stay coarse where this map has no fine samples. Throws Error if the resolutions differ.
  void add_evidence(const StaticMap& other);
  /// As above, restricted to a cube of voxels. On an empty map, this copies a part of the other map. Throws
  /// Error if the resolutions differ, or if the cube's lowest voxel or edge is no multiple of 4.
  void add_evidence(const StaticMap& other, const VoxelIndex& lowest_voxel, int edge_voxels);

  /// Calls `decide` in Morton order for each voxel that has a signed distance or is occupied, and applies the
  /// returned action. SurfaceSample::weight is 0 for voxels without a signed distance. Pruned nodes have no
  /// samples and are not visited.
  void revise_samples(const std::function<SampleAction(const SurfaceSample&)>& decide);
  /// Revises only voxels whose centre is in the box.
  void revise_samples(const Eigen::AlignedBox3d& box_world,
                      const std::function<SampleAction(const SurfaceSample&)>& decide);

  [[nodiscard]] double resolution_m() const;
  /// Returns half the edge length of the octree's cube, which is centred at the world's origin, m.
  [[nodiscard]] double reach_m() const;
  [[nodiscard]] const FusionConfig& config() const;
  /// Returns the memory of the nodes. O(1), so callers can enforce a limit every frame.
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Counts leaves and nodes. Visits the whole tree, which takes about 20 ms per million nodes.
  [[nodiscard]] MapCounts counts() const;

  /// Writes the complete map as compressed blocks, a quarter of the size of .ot. Throws Error if the file
  /// cannot be written.
  void write(const std::filesystem::path& path) const;
  /// Reads a file written by write(). Log-odds, distances, weights and colours are equal to those written. If
  /// the file was written with another config, they are rounded to this config's steps. Validates like
  /// read_ot().
  static StaticMap read(const std::filesystem::path& path, const FusionConfig& config = {});
  /// Writes the complete map in OctoMap's .ot format, with tree type "RoomRadarOcTree". Throws Error if the
  /// file cannot be written.
  void write_ot(const std::filesystem::path& path) const;
  /// Writes the occupancy only (free and occupied leaves), in the .bt format of OctoMap's plain OcTree, which
  /// octovis opens. Throws Error if the file cannot be written.
  void write_bt(const std::filesystem::path& path) const;
  /// Reads a file written by write_ot(). Validates format, depth, sizes and numbers while reading. Rejects
  /// cubes that no sensor produces: free cubes with an edge above 8,192 voxels, and occupied cubes with an
  /// edge above 4 m. Throws Error naming the file and the problem.
  static StaticMap read_ot(const std::filesystem::path& path, const FusionConfig& config = {});

 private:
  struct Octree;
  explicit StaticMap(std::unique_ptr<Octree> octree);
  template <typename ReadFile>
  static StaticMap read_by(const ReadFile& read_file, const FusionConfig& config);
  std::unique_ptr<Octree> octree_;
};

}  // namespace roomradar
