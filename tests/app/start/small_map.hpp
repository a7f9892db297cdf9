// small_map.hpp: a map of a wall, with or without a ball in front of it.
#pragma once
#include <filesystem>

#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::test {

inline void save_small_map(const std::filesystem::path& folder, bool has_ball = false) {
  constexpr Intrinsics kCamera{160, 120, 145.0, 145.0, 79.5, 59.5};
  const Eigen::Isometry3d T_world_camera = looking_at({0, 0, 0}, {1, 0, 0});
  const auto wall = plane(Eigen::Vector3d::UnitX(), 2.01);
  const Scene scene = has_ball ? nearest_of(sphere({1.2, 0.1, 0}, 0.2), wall) : wall;
  SavedMap map;
  map.octree = StaticMap(0.02);
  for (int i = 0; i < 8; ++i)
    map.octree.load().fuse(exact_frame(scene, kCamera, T_world_camera, Rgb{90, 60, 30}), T_world_camera);
  map.mesh = extract_surface(map.octree.load());
  MapKeyframe keyframe;  // the same in all maps: they have one world
  keyframe.T_world_camera = T_world_camera;
  keyframe.points_camera = {{0.1F, 0.2F, 1.5F}};
  keyframe.descriptors = {Descriptor{1, 2, 3}};
  keyframe.preview_camera = {4, 3, 4.0, 4.0, 1.5, 1.0};
  keyframe.preview_depth_mm = {4, 3, 1500};
  map.keyframe_database.load().keyframes = {keyframe};
  map.trajectory.push_back({0, 0.0, T_world_camera});
  map.info.source = "a wall";
  map.info.frames_read = map.info.frames_fused = 8;
  save_map(folder, map);
}

}  // namespace roomradar::test
