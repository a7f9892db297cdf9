// surface_extraction.hpp: extracts the static map's surface as a mesh from the map's signed distances.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_parts.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct SurfaceConfig {
  /// Min weight of a sample; samples with less weight count as unknown. The default is the weight of one
  /// frame at 2.9 m or about ten frames at 5 m, which corresponds to a standard deviation of 13 mm.
  float min_weight = 0.02F;
  /// Strength of smoothing, as a sample weight (1: one measurement from 1 m); 0: no smoothing. Samples with a
  /// higher weight keep their detail. Samples with a lower weight are averaged over more voxels.
  float smoothing = 0.4F;
  float min_component_area_m2 = 4e-3F;  ///< smaller components are dropped (default: about 6 x 6 cm)
  /// Simplification bound: max two-sided (Hausdorff) distance between the simplified and the full surface, m.
  /// 0: no simplification.
  float max_deviation_m = 2e-3F;
};

/// Triangle counts and error of the simplification.
struct SurfaceStats {
  std::size_t full_triangles = 0;  ///< before simplification, without small components
  std::size_t triangles = 0;
  float deviation_m = 0.0F;  ///< measured in both directions; not above max_deviation_m
};

/// Extracts the zero level set of the map's signed distances. Poorly measured distances are smoothed, and
/// small components are dropped. The mesh is simplified within max_deviation_m, and crack-free: every edge
/// has two triangles, or one along a border of the observed surface. Holes stay open. Vertices are in the
/// world frame (mesh.origin + vertex). Normals point towards free space. Colours come from the samples. An
/// empty map gives an empty mesh. Throws Error if a setting is negative or not finite. Methods: see
/// dual_marching_cubes.hpp, tsdf_smoothing.hpp and mesh_simplify.hpp.
/// @param facts  receives the statistics; may be null
Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config = {}, SurfaceStats* facts = nullptr);

/// Extracts the triangles of the map's surface that have a centre in the box, and simplifies them. The parts
/// of boxes beside each other fit without cracks: simplification does not move vertices on their seam. A box
/// contains its lower sides, not its upper ones.
/// @param map  must contain all samples within kSurfaceReach_voxels of the box
SurfacePart extract_surface_part(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                                 const SurfaceConfig& config = {}, SurfaceStats* facts = nullptr);

/// Extracts all triangles with a vertex in the box grown by one voxel. The result can therefore extend two
/// voxels beyond the box. Samples farther than 12 voxels from the box are ignored, and do not count towards
/// the areas of components. These samples would move the result by less than 0.1 mm.
Mesh extract_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                     const SurfaceConfig& config = {});

/// Extracts the surface as measured: not simplified, with small components.
/// @param box_world  samples of cells outside are ignored
Mesh extract_full_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                          const SurfaceConfig& config = {});

/// Number of voxels beyond which a sample has no influence on a vertex. Covers all smoothing sweeps,
/// extrapolation, and samples mirrored across borders between fine and coarse cells.
inline constexpr int kSurfaceReach_voxels = 64;

}  // namespace roomradar
