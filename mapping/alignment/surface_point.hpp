// surface_point.hpp: the surface point that a colour pixel shows.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// The point, in the depth camera, or nothing where there is no depth. Its depth decides where in the depth
/// image to look for it, so it is searched for along the ray, from near and from far.
std::optional<Eigen::Vector3f> surface_point_at(const Frame& frame, const Eigen::Isometry3d& T_depth_colour,
                                                double u_px, double v_px);

}  // namespace roomradar
