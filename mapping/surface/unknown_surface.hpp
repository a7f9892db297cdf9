// unknown_surface.hpp: a surface where seen free space ends and space begins that nobody has seen.
#pragma once
#include <cstddef>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/bit_grid.hpp"
#include "mapping/surface/voxel_face_mesh.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct UnknownSurfaceConfig {
  /// Unknown space counts where a cube of so many voxels a side fits into it, and free space is a place to
  /// come from where one fits into that. Thinner unknown space (gaps between rays, slivers beside depth
  /// edges, single voxels) is taken as what is round it. 1 to 16.
  int least_voxels = 3;
  /// The surface is made of the faces of cubes of so many voxels a side, all of them unknown: it stands less
  /// than a cube behind the border of what counts. 1 to 6.
  int cube_voxels = 2;
  /// The surface goes on for so many voxels behind the rim of what was seen, and through occupied voxels that
  /// the static surface leaves open. 1 to 16, and at least 3 * (cube_voxels - 1): so many steps the nearest
  /// cube may be away from the border.
  int rim_voxels = 4;
  /// A piece of unknown space with fewer voxels, and nothing occupied within cube_voxels steps of
  /// it, does not count: rays passed on all sides and met nothing, so only depth was missing there, as before
  /// something dark. 0 to 10^9.
  int pocket_voxels = 1000;
};

/// Throws Error naming field, value and rule.
void require_valid(const UnknownSurfaceConfig& config);

struct UnknownSurface {
  Mesh mesh_world;    ///< no colours, no normals; triangles look away from the unknown
  CellGrid grid;      ///< of the map's voxels; of a map too large for a bit a voxel, of cubes of them
  VoxelBits unknown;  ///< the grid's cells that are unknown and count; so is all outside of it
  std::size_t memory_bytes = 0;  ///< that making it took, about, besides the mesh
};

/// The border of the unknown space that counts, as far as it can be come to from free space without crossing
/// `surface_world`, the map's own surface. What lies past all that the map knows is unknown too.
///
/// It stands in unknown space, never in free: along each axis less than cube_voxels voxels behind the border
/// of what counts. A straight way from free space that counts into unknown cubes crosses it or the static
/// surface, which it overlaps at the rim; only where the static surface itself has a hole smaller than a
/// voxel may something as thin come through. Rectangles are as large as the cubes allow. Empty for a map
/// without free space. Some 0.4 s for 50 million voxels. Throws Error if the config is out of its rules.
UnknownSurface unknown_surface(const StaticMap& map, const Mesh& surface_world,
                               const UnknownSurfaceConfig& config = {});

/// Whether a point lies in unknown space that counts. True for what is not finite; false everywhere if the
/// map had no free space.
bool is_unknown(const UnknownSurface& surface, const Eigen::Vector3d& p_world);

}  // namespace roomradar
