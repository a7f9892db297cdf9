// surface_patch.hpp: a part of the map's surface made anew, in the place of the old one.
#pragma once
#include <Eigen/Geometry>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Makes the surface anew in a box, from what the map says now, and leaves the mesh as it is outside: old
/// triangles are cut where they enter the box, new ones reach a voxel or two out of it, so that no gap stays
/// between the two; there both lie within twice config.max_deviation_m of the full surface. Costs by the
/// box's content, and by the mesh's triangles as far as they must be looked at.
///
/// @param mesh  as extract_surface() gives it, in the world; normals and colours stay only if it has one a
///              vertex
/// Nothing changes if the box is empty. Throws Error if the config is out of its rules.
void renew_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world, const SurfaceConfig& config,
                   Mesh& mesh);

/// What of a mesh lies outside of a box: triangles across its sides are cut there, vertices interpolated.
/// Vertices that no triangle uses stay out.
Mesh outside_of(const Mesh& mesh, const Eigen::AlignedBox3d& box_world);

}  // namespace roomradar
