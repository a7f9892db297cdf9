// surface_point.hpp: 3D surface point that a colour pixel shows.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Returns the surface point at colour pixel (u_px, v_px), in the depth camera's frame, m; nullopt if no
/// depth is measured for this pixel. The matching depth pixel depends on the point's depth, so the function
/// iterates along the colour pixel's ray. The iteration starts from depth 0.8 m and, if that does not
/// converge, from 3 m.
std::optional<Eigen::Vector3f> surface_point_at(const Frame& frame, const Eigen::Isometry3d& T_depth_colour,
                                                double u_px, double v_px);

}  // namespace roomradar
