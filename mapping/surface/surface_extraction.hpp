// surface_extraction.hpp: extracts the static map's surface as a mesh from its signed distances.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct SurfaceConfig {
  /// Samples with less weight count as unknown. Default: the weight of one frame at 2.9 m or about ten frames
  /// at 5 m, a standard deviation of 13 mm.
  float min_weight = 0.02F;
  /// Strength of smoothing, as a sample weight (1: one measurement from 1 m); 0: none. Samples of higher
  /// weight keep their detail; samples of lower weight are averaged over more voxels.
  float smoothing = 0.4F;
  float min_component_area_m2 = 4e-3F;  ///< smaller components are dropped (default: about 6 x 6 cm)
  /// Simplification bound: max distance between the simplified and the full surface, in both directions; 0
  /// keeps every triangle.
  float max_deviation_m = 2e-3F;
};

/// Triangle counts and error of the simplification.
struct SurfaceStats {
  std::size_t full_triangles = 0;  ///< at voxel resolution, small components dropped
  std::size_t triangles = 0;
  float deviation_m = 0.0F;  ///< measured in both directions; not above max_deviation_m
};

/// Extracts the zero level set of the map's signed distances: smoothed where poorly measured, without small
/// components, and simplified within max_deviation_m into large triangles on flat areas and small ones on
/// curved ones. Crack-free: every edge has two triangles, or one along a border of the observed surface, so
/// holes stay open. Vertices are in the world (mesh.origin + vertex), normals point to the free side, colours
/// come from the samples. An empty map gives an empty mesh. Throws Error if a setting is not finite and >= 0.
/// Methods: see dual_marching_cubes.hpp, tsdf_smoothing.hpp and mesh_simplify.hpp.
/// @param facts  receives the statistics; may be null
Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config = {}, SurfaceStats* facts = nullptr);

/// Extracts the part of the surface in a box: all triangles with a corner in the box grown by one voxel, so
/// up to two voxels beyond the box. Samples farther than 12 voxels from the box would move the result by less
/// than 0.1 mm and are ignored, also when the area of a component is measured.
Mesh extract_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                     const SurfaceConfig& config = {});

}  // namespace roomradar
