// surface_point.hpp: 3D surface point that a colour pixel shows.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Returns the surface point at colour pixel (u_px, v_px), in the depth camera's frame, m; nullopt if there
/// is no depth. The matching depth pixel depends on the point's depth, so the function iterates along the
/// colour pixel's ray, first from a near and then from a far starting depth.
std::optional<Eigen::Vector3f> surface_point_at(const Frame& frame, const Eigen::Isometry3d& T_depth_colour,
                                                double u_px, double v_px);

}  // namespace roomradar
