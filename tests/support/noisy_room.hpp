// noisy_room.hpp: a small room with painted walls and a Kinect's noise, and a camera path through it.
#pragma once
#include <numbers>
#include <vector>

#include "mapping/odometry/odometry.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::test {

inline constexpr Intrinsics kRoomCamera{320, 240, 292.5, 292.5, 159.5, 119.5};

inline Scene room() {
  const Scene walls = nearest_of(nearest_of(plane({0, 0, 1}, 0.0), plane({0, 1, 0}, 2.5)),
                                 nearest_of(plane({1, 0, 0}, -1.8), plane({1, 0, 0}, 1.8)));
  const Scene things =
      nearest_of(box(Eigen::AlignedBox3d(Eigen::Vector3d(-0.7, 1.2, 0), Eigen::Vector3d(0.3, 1.9, 0.7))),
                 sphere({0.9, 1.8, 0.3}, 0.3));
  return nearest_of(walls, things);
}

/// Camera i of a path that sways sideways and returns to its start at i = `frames`.
inline Eigen::Isometry3d on_path(int i, int frames) {
  const double a = 2.0 * std::numbers::pi * i / frames;
  return looking_at({0.3 * std::sin(a), -0.3 + 0.1 * (1 - std::cos(a)), 1.2},
                    {0.4 * std::sin(a), 2.0, 0.5 + 0.1 * std::sin(a)});
}

inline Frame frame_at(const Eigen::Isometry3d& T_world_camera, int index, const Scene& scene = room()) {
  Frame frame = exact_frame(scene, kRoomCamera, T_world_camera);
  paint(frame, T_world_camera);
  add_depth_noise(frame, static_cast<unsigned>(index));
  frame.index = index;
  frame.stamp_s = index / 30.0;
  return frame;
}

inline Frame dark_frame(int index) {
  Frame frame = frame_at(on_path(0, 1), index);
  std::fill(frame.depth_m.pixels.begin(), frame.depth_m.pixels.end(), 0.0F);
  std::fill(frame.colour.pixels.begin(), frame.colour.pixels.end(), Rgb{});
  return frame;
}

inline std::vector<TimedPose> timed(const std::vector<TrackedFrame>& frames) {
  std::vector<TimedPose> poses;
  for (const TrackedFrame& f : frames) poses.push_back({f.frame_index, f.stamp_s, f.T_world_camera});
  return poses;
}

}  // namespace roomradar::test
