// view_selection.hpp: chooses the frames of a scan whose colour is baked into the texture.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

namespace roomradar {

/// A frame from which views are chosen.
struct ViewCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double image_speed_pxps = 0.0;  ///< see image_speed_pxps(); a fast camera's picture is blurred
};

/// Returns the indices of at most max_views candidates, increasing. Divides the scan into segments within
/// which the camera moves by less than 5 cm and 3 degrees. Chooses the slowest frame of each segment, unless
/// a frame chosen earlier has about the same pose. If more than max_views are chosen, repeats with longer
/// segments.
std::vector<std::size_t> choose_views(std::span<const ViewCandidate> candidates, std::size_t max_views);

}  // namespace roomradar
