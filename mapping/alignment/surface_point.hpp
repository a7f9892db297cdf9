// surface_point.hpp: 3D surface point at a colour pixel.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Returns the point in the depth camera's frame, m; nullopt if there is no depth. The matching depth pixel
/// depends on the point's depth, so the function iterates along the colour ray from two starts, near and far.
std::optional<Eigen::Vector3f> surface_point_at(const Frame& frame, const Eigen::Isometry3d& T_depth_colour,
                                                double u_px, double v_px);

}  // namespace roomradar
