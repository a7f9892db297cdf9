// surface_update.hpp: replaces the map's surface mesh inside a box by a newly extracted one.
#pragma once
#include <Eigen/Geometry>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Re-extracts the surface in a box from the current map. The mesh outside the box is unchanged. Old
/// triangles are cut at the box. New triangles extend one or two voxels beyond the box, so no gap remains. In
/// this overlap, old and new triangles are within twice config.max_deviation_m of the unsimplified surface.
/// The time is proportional to the content of the box, plus one pass over the mesh's triangles. Changes
/// nothing if the box is empty. Throws Error if the config is invalid.
///
/// @param mesh  result of extract_surface(), in the world. Normals and colours are kept only if every vertex
///              has them
void update_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world, const SurfaceConfig& config,
                    Mesh& mesh);

/// Returns the part of a mesh outside a box. Triangles that cross a side of the box are cut at that side,
/// with interpolated vertices. Unused vertices are dropped.
Mesh clip_outside(const Mesh& mesh, const Eigen::AlignedBox3d& box_world);

}  // namespace roomradar
