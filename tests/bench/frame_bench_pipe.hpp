// frame_bench_pipe.hpp: frames from frame_bench_reader to frame_bench through a pipe. Both programs must come
// from the same build.
#pragma once
#include <cstdio>
#include <type_traits>

#include "mapping/types/frame.hpp"

namespace roomradar::bench {

/// Calls move(pointer, bytes) for each fixed-size part of the frame, then for the images once their sizes are
/// known. Leaves out fields that a session does not use (gravity).
template <typename Move>
bool move_frame(Frame& frame, const Move& move) {
  const auto move_value = [&](auto& value) {
    static_assert(std::is_trivially_copyable_v<std::decay_t<decltype(value)>>);
    return move(&value, sizeof(value));
  };
  Eigen::Matrix4d T_world_camera = frame.T_world_camera.value_or(Eigen::Isometry3d::Identity()).matrix();
  bool has_pose = frame.T_world_camera.has_value(), has_colour = !frame.colour.empty();
  if (!(move_value(frame.index) && move_value(frame.stamp_s) && move_value(frame.depth_camera) &&
        move_value(frame.colour_camera) && move(frame.T_colour_depth.data(), 16 * sizeof(double)) &&
        move(T_world_camera.data(), 16 * sizeof(double)) && move_value(has_pose) && move_value(has_colour)))
    return false;
  if (has_pose) frame.T_world_camera = Eigen::Isometry3d(T_world_camera);
  if (frame.depth_m.empty()) frame.depth_m.resize(frame.depth_camera.width_px, frame.depth_camera.height_px);
  if (has_colour && frame.colour.empty())
    frame.colour.resize(frame.colour_camera.width_px, frame.colour_camera.height_px);
  return move(frame.depth_m.pixels.data(), frame.depth_m.pixels.size() * sizeof(float)) &&
         (!has_colour || move(frame.colour.pixels.data(), frame.colour.pixels.size() * sizeof(Rgb)));
}

inline bool write_frame(Frame frame, std::FILE* to) {
  return move_frame(
      frame, [&](const void* from, std::size_t bytes) { return std::fwrite(from, 1, bytes, to) == bytes; });
}
/// Returns false at the end.
inline bool read_frame(std::FILE* from, Frame& frame) {
  frame = {};
  return move_frame(frame,
                    [&](void* to, std::size_t bytes) { return std::fread(to, 1, bytes, from) == bytes; });
}

}  // namespace roomradar::bench
