// roomradar_locator.cpp: the camera's pose in a saved room, and the room's depth.
#include "app/c_api/roomradar_locator.h"

#include <span>
#include <utility>

#include "app/c_api/conversions.hpp"
#include "app/c_api/session_state.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

static_assert(static_cast<int>(TrackStatus::kTracked) == ROOMRADAR_TRACKED &&
              static_cast<int>(TrackStatus::kTooFewPoints) == ROOMRADAR_TOO_FEW_POINTS &&
              static_cast<int>(TrackStatus::kDegenerate) == ROOMRADAR_DEGENERATE &&
              static_cast<int>(TrackStatus::kDiverged) == ROOMRADAR_DIVERGED &&
              static_cast<int>(TrackStatus::kUncertain) == ROOMRADAR_UNCERTAIN);

roomradar_status roomradar_locator_open(const roomradar_map* map, roomradar_locator** locator) {
  return guarded("roomradar_locator_open", nullptr, [&] {
    require_given(locator, "locator");
    auto state = std::make_shared<LocatorState>();
    state->map = object_of<MapState>(map);
    state->thread.run(
        [&] { state->rendered = std::make_unique<LocatorState::Rendered>(state->map->map.mesh); });
    *locator = HandleTable<LocatorState>::get().add<roomradar_locator>(std::move(state));
  });
}

roomradar_status roomradar_locator_close(roomradar_locator* locator) {
  return c_api::close<LocatorState>("roomradar_locator_close", locator);
}

const char* roomradar_locator_error(const roomradar_locator* locator) {
  return error_of<LocatorState>(locator);
}

roomradar_status roomradar_locator_locate(roomradar_locator* locator, const roomradar_frame* frame,
                                          roomradar_location* location) {
  return with<LocatorState>("roomradar_locator_locate", locator, [&](LocatorState& state) {
    require_struct(location, "location");
    read_frame(frame, state.frame);
    Tracking tracking;
    state.thread.run([&] {
      const auto expected_depth = [&](const Eigen::Isometry3d& T_world_camera) -> const DepthImage& {
        return state.rendered->scene.render_expected(state.frame.depth_camera, T_world_camera).depth_m;
      };
      tracking =
          locate(state.locator, state.frame, state.map->map.keyframe_database.load(), {}, expected_depth);
    });
    location->tracking = static_cast<int32_t>(tracking.status);
    location->T_world_camera = pose_of(tracking.T_world_camera);
    location->rms_m = tracking.rms_m;
    location->inlier_fraction = tracking.inlier_fraction;
  });
}

roomradar_status roomradar_locator_forget(roomradar_locator* locator) {
  return with<LocatorState>("roomradar_locator_forget", locator, [](LocatorState& state) {
    MapIndices index = std::move(state.locator.index);  // of the map, not of the camera
    state.locator = {};
    state.locator.index = std::move(index);
  });
}

roomradar_status roomradar_locator_expected_depth(roomradar_locator* locator, const roomradar_camera* camera,
                                                  const roomradar_pose* T_world_camera, float* depth_m,
                                                  size_t capacity, size_t* needed) {
  return with<LocatorState>("roomradar_locator_expected_depth", locator, [&](LocatorState& state) {
    const Intrinsics from = camera_of(camera, "camera");
    const Eigen::Isometry3d T = pose_of(T_world_camera, "T_world_camera");
    require_capacity(depth_m, capacity,
                     static_cast<size_t>(from.width_px) * static_cast<size_t>(from.height_px), needed);
    state.thread.run([&] {
      const DepthImage& rendered = state.rendered->scene.render_expected(from, T).depth_m;
      write_array(std::span<const float>(rendered.pixels), depth_m, capacity, needed);
    });
  });
}
