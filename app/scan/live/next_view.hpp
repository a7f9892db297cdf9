// next_view.hpp: finds the view that is expected to show the most unseen surface per time (next best view).
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "app/scan/live/exploration_grid.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct NextView {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double gain_m2 = 0.0;  ///< expected area of unseen surface in the view and on the path to it
  double takes_s = 0.0;  ///< time to move a hand-held camera to the view
};

/// Tests views at all azimuths, from the camera's position and from positions up to 1.5 m away to which a
/// straight path through free space leads. The gain of a view is the area of the frontier between free and
/// unknown space that rays of up to 3.5 m hit, from the view and from the path to it. The area that a ray
/// contributes is computed at a distance of at least 1.3 m, where surface is expected behind nearer
/// frontiers. Returns the view with the highest gain per time; nullopt if no view has a gain of at least 0.15
/// m2. Takes about 150 ms.
/// @param up_world  unit vector
std::optional<NextView> best_next_view(const ExplorationGrid& grid, const Eigen::Isometry3d& T_world_camera,
                                       const Eigen::Vector3d& up_world);

/// Returns a view from viewpoint_world towards point_world, with a horizontal x axis.
NextView view_of(const Eigen::Vector3d& point_world, const Eigen::Vector3d& viewpoint_world,
                 const Eigen::Vector3d& up_world);

/// Returns directions from the camera to a view in words, such as "go forward 0.8 m, turn left 60\u00B0".
std::string way_to(const NextView& next, const Eigen::Isometry3d& T_world_camera,
                   const Eigen::Vector3d& up_world);

}  // namespace roomradar
