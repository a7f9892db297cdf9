// unknown_surface.hpp: extracts the border between observed free space and unknown space as a surface; reads
// and writes it as a binary file.
#pragma once
#include <cstddef>
#include <filesystem>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/unknown/run_grid.hpp"
#include "mapping/surface/unknown/voxel_face_mesh.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

inline constexpr double kMaxUnknownCells = 2e8;  ///< max cells of the grid: 25 MB of bits

struct UnknownSurfaceConfig {
  /// Edge of a cube, voxels, 1 to 16. Unknown space counts only where the cube fits into it. Objects can pass
  /// through thinner unknown space (gaps between rays, slivers beside depth edges, single voxels). The search
  /// for reachable unknown space starts in free space that holds the cube.
  int least_voxels = 3;
  /// Edge, voxels, 1 to 6, of the unknown cubes whose faces form the surface. The surface is less than one
  /// cube edge behind the border of the unknown space that counts.
  int cube_voxels = 2;
  /// Number of voxels by which the surface continues past the border of observed surfaces, and through
  /// occupied voxels without surface in the static mesh. 1 to 16, and at least 3 * (cube_voxels - 1), the max
  /// number of steps from the border to the nearest cube.
  int rim_voxels = 4;
  /// Min number of voxels, 0 to 10^9, of a connected component of unknown space that has no occupied voxel
  /// within cube_voxels steps. Smaller such components do not count. Rays passed them on all sides, and only
  /// depth was missing, as in front of a dark object.
  int pocket_voxels = 1000;
  /// Max number of cells of the grid, 100,000 to kMaxUnknownCells. Cells are one voxel each, or larger if the
  /// map would have more.
  double max_cells = kMaxUnknownCells;
};

/// Throws Error naming field, value and rule if a setting is out of range.
void require_valid(const UnknownSurfaceConfig& config);

struct UnknownSurface {
  Mesh mesh_world;  ///< no colours, no normals; triangles face away from unknown space
  CellGrid grid;    ///< cells of one voxel each, or larger, see max_cells
  RunGrid unknown;  ///< cells of unknown space that counts; all space outside the grid is unknown, too
  std::size_t memory_bytes = 0;  ///< approximate temporary memory of the extraction, without the mesh
};

/// Extracts the border of the unknown space that counts (see UnknownSurfaceConfig). Only the border that can
/// be reached from free space without crossing `surface_world`, the map's own surface, is extracted. Space
/// outside the known bounds of the map is unknown, too.
///
/// The resulting surface is inside unknown space, never in free space. Along each axis, it is less than
/// cube_voxels voxels behind the border of unknown space. A straight path from the free space in which the
/// search started into unknown cubes crosses this surface or the static surface. The two overlap at the
/// border of observed surfaces. Only an object thinner than a voxel may slip through an equally small hole of
/// the static surface. Cube faces are merged into rectangles as large as possible. The result is empty for a
/// map without free space. Takes about 0.4 s for 50 million voxels. Throws Error if the config is invalid.
UnknownSurface unknown_surface(const StaticMap& map, const Mesh& surface_world,
                               const UnknownSurfaceConfig& config = {});

/// Returns true if a point is in unknown space that counts, or is not finite. Returns false for every point
/// if the map had no free space.
bool is_unknown(const UnknownSurface& surface, const Eigen::Vector3d& p_world);

/// Writes the surface and the cells of unknown space as one binary file with a checksum. Throws Error if the
/// file cannot be written.
void write_unknown_surface(const UnknownSurface& surface, const std::filesystem::path& path);

/// Reads a file written by write_unknown_surface(). UnknownSurface::memory_bytes is not stored and is 0.
/// Throws Error naming the file and the fault if the file is missing, truncated, altered, or of another
/// version. Sizes are checked before memory is allocated.
UnknownSurface read_unknown_surface(const std::filesystem::path& path);

}  // namespace roomradar
