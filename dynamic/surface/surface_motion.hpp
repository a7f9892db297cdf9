// surface_motion.hpp: estimates the motion of a dynamic surface near a point since the last frame.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Sets points_world to the back-projected dynamic pixels with depth, row by row. Takes every n-th row and
/// column, so that at most about 20,000 pixels are read.
void dynamic_points(const DepthImage& depth_m, const MaskImage& dynamic_mask, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_world_camera, std::vector<Eigen::Vector3d>& points_world);

/// Estimates the translation of a surface between two frames near a point, by registration of the surface's
/// points. A candidate is zero, or the translation from a point of the last frame to a new point. New points
/// are the four points of this frame that are farthest from all points of the last frame. The best candidate
/// is refined by ICP. A point more than 3 cm from every point of the other frame has no match. For a hand
/// that enters the view or rotates, the result is thus the translation of its part near the point.
/// @param before_world, now_world  points of the surface, see dynamic_points()
/// @param centre_world, reach_m    only points of `now_world` within reach_m of the centre count
/// @param farthest_m               max translation found
/// @return nullopt if fewer than 12 points are near, or if the best translation leaves an RMS distance of 15
///         mm or more between the two sets of points
/// Source: Besl, McKay, A method for registration of 3-D shapes, PAMI 1992.
std::optional<Eigen::Vector3d> translation_near(std::span<const Eigen::Vector3d> before_world,
                                                std::span<const Eigen::Vector3d> now_world,
                                                const Eigen::Vector3d& centre_world, double reach_m,
                                                double farthest_m);

}  // namespace roomradar
