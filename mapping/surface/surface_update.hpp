// surface_update.hpp: replaces part of the map's surface mesh by a newly extracted one.
#pragma once
#include <Eigen/Geometry>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Re-extracts the surface in a box from the current map and leaves the mesh outside unchanged. Old triangles
/// are cut at the box; new ones extend one or two voxels beyond it, so no gap remains. In this overlap, old
/// and new triangles are within twice config.max_deviation_m of the unsimplified surface. Cost: the content
/// of the box, plus one pass over the mesh's triangles. No change if the box is empty. Throws Error if the
/// config is invalid.
///
/// @param mesh  as from extract_surface(), in the world; normals and colours are kept only if every vertex
///              has them
void update_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world, const SurfaceConfig& config,
                    Mesh& mesh);

/// Returns the part of a mesh outside a box: triangles across the box's sides are cut there, with
/// interpolated vertices. Unused vertices are dropped.
Mesh clip_outside(const Mesh& mesh, const Eigen::AlignedBox3d& box_world);

}  // namespace roomradar
