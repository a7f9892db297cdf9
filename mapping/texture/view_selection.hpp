// view_selection.hpp: chooses the frames of a scan whose colour is baked into the texture.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

namespace roomradar {

/// A frame that could be used.
struct ViewCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double image_speed_pxps = 0.0;  ///< see image_speed_pxps(); a fast camera's picture is blurred
};

/// Returns the indices of at most max_views candidates, increasing. The scan is divided where the camera has
/// moved by 5 cm or 3 degrees; each part gives its slowest frame. A part whose view was chosen before gives
/// none. If there are too many parts, they are made longer.
std::vector<std::size_t> choose_views(std::span<const ViewCandidate> candidates, std::size_t max_views);

}  // namespace roomradar
