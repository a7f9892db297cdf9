// surface.hpp: the static map's surface as triangles, placed by signed distance.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct SurfaceConfig {
  /// Samples with less are taken as unknown: the least is what one frame says from 2.9 m, or eight frames
  /// from 5 m, and stands for a standard deviation of 9 mm.
  float min_weight = 0.02F;
  /// Strength of the averaging over neighbours, in measurements from 1 m: what is better measured keeps its
  /// detail, what is worse is smoothed over more voxels. 0: none.
  float smoothing = 0.4F;
  float min_component_area_m2 = 4e-3F;  ///< connected pieces with less area are specks (about 6 x 6 cm)
  /// No point of the surface lies farther from the one with all triangles, nor the other way; 0 keeps every
  /// triangle.
  float max_deviation_m = 2e-3F;
};

/// What became of the triangles.
struct SurfaceFacts {
  std::size_t full_triangles = 0;  ///< one voxel fine, specks taken out
  std::size_t triangles = 0;
  float deviation_m = 0.0F;  ///< measured between the two, both ways; not above max_deviation_m
};

/// The zero surface of the map's signed distances, smoothed where they are poorly measured, without specks,
/// with as few triangles as max_deviation_m allows: large ones where it is flat, small ones where it bends.
/// No cracks: every edge has two triangles, or one along a border of what was seen, so that holes stay open.
/// Vertices are in the world (mesh.origin + vertex), normals point to the free side, colours are the
/// samples'. An empty map gives an empty mesh. Throws Error if the config is out of its rules (values finite
/// and >= 0). Source: in surface_net.hpp, sample_smoothing.hpp and mesh_simplify.hpp.
Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config = {}, SurfaceFacts* facts = nullptr);

/// The part of it in a box, and up to two voxels round it: triangles with a corner in the box grown by one
/// voxel. Samples farther from the box than 12 voxels are not looked at; they would move this part by less
/// than 0.1 mm. Pieces are judged as specks by what of them lies within those 12 voxels.
Mesh extract_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                     const SurfaceConfig& config = {});

}  // namespace roomradar
