// drop_request.cpp: finds a place in view on the room's own depth.
#include "app/session/drop_request.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "app/physics/placement.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns the room's depth; 0 where something dynamic is in front of it and might stand on it.
DepthImage seen_room_depth_m(const ExpectedView& expected, const FrameForeground& foreground) {
  DepthImage depth_m = expected.depth_m;
  const MaskImage& moved = foreground.dynamic_mask;
  for (std::size_t i = 0; i < std::min(moved.pixels.size(), depth_m.pixels.size()); ++i)
    if (moved.pixels[i] != 0) depth_m.pixels[i] = 0.0F;
  return depth_m;
}

}  // namespace

void require_small_enough(const VirtualObject& object, const DropRequest& drop) {
  const double reach_m =
      footprint_radius_m(object, drop.R_world_object.value_or(object.body.T_world_object.linear()));
  if (reach_m <= kMostFootprint_m) return;
  std::array<char, 240> text{};
  std::snprintf(
      text.data(), text.size(),
      ": reaches %.3g m sideways from its middle, and only what reaches at most %.0f m is dropped in view. "
      "Meshes are in metres: give it a size (add NAME FILE size 0.2) or a place (drop NAME at X Y Z)",
      reach_m, kMostFootprint_m);
  throw Error(object.body.name + text.data());
}

std::optional<Eigen::Vector3d> find_drop_position(const VirtualObject& object,
                                                  const Eigen::Matrix3d& R_world_object,
                                                  const Intrinsics& camera,
                                                  const Eigen::Isometry3d& T_world_camera,
                                                  const ExpectedView& expected,
                                                  const FrameForeground& foreground) {
  const std::optional<Eigen::Vector3d> support_world =
      find_support(seen_room_depth_m(expected, foreground), camera, T_world_camera,
                   footprint_radius_m(object, R_world_object));
  if (!support_world) return std::nullopt;
  return *support_world - level_to_middle(object, R_world_object);
}

}  // namespace roomradar
