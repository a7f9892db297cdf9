// arkit_axes.hpp: the axes of ARKit's poses.
#pragma once
#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// States that the recording's world frame is ARKit's: y up and aligned with gravity.
/// @param camera_is_opengl  the recorded camera has ARKit's own axes: x right, y up, z backwards. Otherwise it
///                          has roomradar's
inline void set_arkit_axes(RecordingFacts& facts, bool camera_is_opengl) {
  facts.T_world_statedworld.linear() << 1, 0, 0,  //
      0, 0, -1,                                   //
      0, 1, 0;
  if (camera_is_opengl) facts.T_statedcamera_camera.linear().diagonal() << 1, -1, -1;
  facts.is_world_level = true;
  facts.gravity_source = "poses, whose world frame is level";
}

}  // namespace roomradar
