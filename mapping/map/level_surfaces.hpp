// level_surfaces.hpp: floor, table tops and other horizontal ("level") surfaces of a room.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A connected horizontal surface that faces up, in a world frame with +z up.
struct LevelSurface {
  double height_m = 0.0;  ///< mean z
  double area_m2 = 0.0;
  Eigen::Vector3d middle_world = Eigen::Vector3d::Zero();  ///< centre of the triangle nearest to the centroid
};

/// Returns the level surfaces of a mesh, largest first. Triangles count as level if their normal is within 10
/// degrees of +z. Level triangles that share vertices form one surface. Of a surface, only the triangles
/// within 3 cm of its most frequent height count. Surfaces under min_area_m2 are left out.
std::vector<LevelSurface> level_surfaces(const Mesh& mesh_world, double min_area_m2 = 0.05);

/// Returns, per surface, true if it is a part of the floor. The floor is the lowest surface with at least a
/// tenth of the largest surface's area, and all surfaces within 3 cm of its height. If at least 2 % of the
/// mesh's area is more than 15 cm below this height, the lowest surface is a table or shelf, and no surface
/// is a part of the floor.
/// @param surfaces  level_surfaces() of the mesh, in any order
std::vector<bool> floor_among(std::span<const LevelSurface> surfaces, const Mesh& mesh_world);

/// Returns the height of the floor above the keyframes' world origin along `up_world`, m. The floor is the
/// lowest height at which the keyframes' depth shows at least a tenth as much level surface as at the height
/// with most of it. Surface that several keyframes show counts once. Returns nullopt if less than 0.05 m2 of
/// level surface is measured.
/// @param up_world  unit vector
std::optional<double> floor_height_m(const KeyframeDatabase& keyframe_database,
                                     const Eigen::Vector3d& up_world);

}  // namespace roomradar
