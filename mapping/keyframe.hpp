// keyframe.hpp: a view that later ones are aligned with, its depth made better by what follows.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>

#include "mapping/view.hpp"

namespace roomradar {

struct Keyframe {
  std::int64_t frame_index = 0;
  ViewPyramid pyramid;             ///< the finest level's depth is the mean of all measurements so far
  Image<std::uint8_t> measured;    ///< how many measurements that is, a pixel
  ReferenceView reference;         ///< made from the pyramid; holds the pose
  int improved_since_refresh = 0;  ///< views added since the reference was made
};

Keyframe make_keyframe(std::int64_t frame_index, const ViewPyramid& pyramid,
                       const Eigen::Isometry3d& T_world_camera, const ViewConfig& config);

/// Averages another view's depth into the keyframe's where both see the same surface. The reference stays as
/// it is until refresh().
void improve_depth(Keyframe& keyframe, const ViewPyramid& view, const Eigen::Isometry3d& T_world_view);

/// Makes the reference anew from the improved depth.
void refresh(Keyframe& keyframe, const ViewConfig& config);

}  // namespace roomradar
