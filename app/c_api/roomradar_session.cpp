// roomradar_session.cpp: exported functions for sessions.
#include "app/c_api/roomradar_session.h"

#include <chrono>
#include <span>
#include <string>
#include <utility>

#include "app/c_api/conversions.hpp"
#include "app/c_api/session_state.hpp"
#include "app/quality/quality.hpp"
#include "app/session/apply_quality.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

namespace {

SurfacePolicy surfaces_of(int32_t surfaces) {
  switch (surfaces) {
    case ROOMRADAR_SURFACES_MAP:
      return SurfacePolicy::kMap;
    case ROOMRADAR_SURFACES_HOLES:
      return SurfacePolicy::kHoles;
    case ROOMRADAR_SURFACES_SKIRT:
      return SurfacePolicy::kSkirt;
    case ROOMRADAR_SURFACES_BORDER:
      return SurfacePolicy::kBorder;
    default:
      refuse("surfaces = " + std::to_string(surfaces) + ": must be a roomradar_surfaces, 0..3");
  }
}

/// Reads words such as "depth_stride=2 radar=sampled".
RunQuality quality_of(const char* words) {
  RunQuality quality;
  constexpr std::size_t kLongest = 4096;
  const std::string text = words == nullptr ? "" : std::string(words, strnlen(words, kLongest + 1));
  if (text.size() > kLongest)
    refuse("quality: is longer than " + std::to_string(kLongest) + " characters; is it null-terminated?");
  constexpr const char* kBlanks = " \t\n,";
  for (std::size_t from = text.find_first_not_of(kBlanks); from != std::string::npos;) {
    const std::size_t to = std::min(text.find_first_of(kBlanks, from), text.size());
    const std::string word = text.substr(from, to - from);
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) refuse("quality: \"" + word + "\" is not NAME=VALUE");
    set_field(quality, word.substr(0, equals), word.substr(equals + 1));
    from = text.find_first_not_of(kBlanks, to);
  }
  require_valid(quality);
  return quality;
}

SessionConfig config_of(const roomradar_session_options& options, const MapInfo& info) {
  if (options.poses < ROOMRADAR_POSES_TRACKED || options.poses > ROOMRADAR_POSES_AUTO)
    refuse("options.poses = " + std::to_string(options.poses) + ": must be a roomradar_poses, 0..3");
  SessionConfig config;
  config.poses = options.poses == ROOMRADAR_POSES_TRACKED ? PoseOrigin::kTracked
                 : options.poses == ROOMRADAR_POSES_AUTO  ? PoseOrigin::kAuto
                                                          : PoseOrigin::kRecorded;
  config.scene.surfaces = surfaces_of(options.surfaces);
  apply(quality_of(options.quality), config);
  config.make_picture = options.has_no_picture == 0;
  if (options.watches_changes == 0) return config;
  config.map_updates.emplace();
  if (number_of(options.adopt_after_s, "options.adopt_after_s") != 0.0)
    config.map_updates->after_s = options.adopt_after_s;
  config.map_updates->surface = surface_config_of(info);
  config.map_updates->wait = options.may_adopt_late == 0;
  return config;
}

void write_result(const FrameResult& from, const SessionState& state, double frame_ms,
                  roomradar_frame_result& to) {
  to.is_located = from.status == FrameStatus::kDone ? 1 : 0;
  to.tracking = static_cast<int32_t>(from.tracking);
  to.T_world_camera = pose_of(from.T_world_camera);
  to.picture_is_new = from.picture_is_new ? 1 : 0;
  to.contacts = from.contacts;
  for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
    to.contacts_by_kind[kind] = from.contacts_by_kind[kind];
  to.departures = static_cast<int32_t>(from.departures.size());
  to.notices = static_cast<int32_t>(state.notices.size());
  to.moved_pixels = static_cast<uint64_t>(from.foreground.moved);
  to.moved_triangles = from.dynamic_triangles;
  to.room_version = state.room_version;
  to.frame_ms = frame_ms;
  to.contact_ms = 0.0;
  if (to.is_located != 0)
    state.times.visit_newest([&](const std::string& stage, std::size_t, float newest_ms) {
      if (stage == "contact") to.contact_ms = static_cast<double>(newest_ms);
    });
}

}  // namespace

roomradar_status roomradar_session_open(const roomradar_map* map, const roomradar_session_options* options,
                                        roomradar_session** session) {
  return guarded("roomradar_session_open", nullptr, [&] {
    require_given(session, "session");
    const auto wanted = options_of(options, "options");
    auto state = std::make_shared<SessionState>();
    std::shared_ptr<const MapState> shared = object_of<MapState>(map);
    const SessionConfig config = config_of(wanted, shared->map.info);
    state->poses = wanted.poses;
    if (config.map_updates) {
      state->own_map = load_map(shared->folder);
      state->own_map->texture.load();  // is carried over when the map is saved
    } else {
      state->shared_map = std::move(shared);
    }
    state->thread.run([&] {
      StaticMap* const octree = state->own_map ? &state->own_map->octree.load() : nullptr;
      state->session = std::make_unique<Session>(state->map(), config, octree);
      if (wanted.unknown_is_solid != 0) state->session->make_unknown_solid(state->times);
    });
    state->look_for_new_room();
    *session = HandleTable<SessionState>::get().add<roomradar_session>(std::move(state));
  });
}

roomradar_status roomradar_session_close(roomradar_session* session) {
  return c_api::close<SessionState>("roomradar_session_close", session);
}

const char* roomradar_session_error(const roomradar_session* session) {
  return error_of<SessionState>(session);
}

roomradar_status roomradar_session_step(roomradar_session* session, const roomradar_frame* frame,
                                        roomradar_frame_result* result) {
  return with<SessionState>("roomradar_session_step", session, [&](SessionState& state) {
    const auto start = std::chrono::steady_clock::now();
    if (result != nullptr) require_struct(result, "result");
    read_frame(frame, state.frame);
    if (state.poses == ROOMRADAR_POSES_GIVEN && state.frame.T_world_camera)
      state.frame.T_world_camera = state.map().info.T_world_recorded.inverse() * *state.frame.T_world_camera;
    FrameResult stepped;
    state.run([&](Session& live) { stepped = live.step(state.frame, state.times); });
    if (stepped.status == FrameStatus::kBadFrame) refuse(std::string(stepped.fault));
    if (stepped.status == FrameStatus::kDone) ++state.located_frames;
    state.sigma = stepped.sigma;
    state.keep(stepped.notices);
    state.look_for_new_room();
    if (result != nullptr) write_result(stepped, state, ms_since(start), *result);
  });
}

roomradar_status roomradar_session_pose_sigma(roomradar_session* session, double sigma_m[3],
                                              double sigma_rad[3]) {
  return with<SessionState>("roomradar_session_pose_sigma", session, [&](SessionState& state) {
    require_given(sigma_m, "sigma_m");
    for (int axis = 0; axis < 3; ++axis) {
      sigma_m[axis] = state.sigma.position_m(axis);
      if (sigma_rad != nullptr) sigma_rad[axis] = state.sigma.rotation_rad(axis);
    }
  });
}

roomradar_status roomradar_session_picture(roomradar_session* session, uint8_t* rgb, size_t capacity,
                                           size_t* needed, int32_t* width_px, int32_t* height_px) {
  return with<SessionState>("roomradar_session_picture", session, [&](SessionState& state) {
    const ColourImage& picture = state.session->picture();
    if (width_px != nullptr) *width_px = picture.width;
    if (height_px != nullptr) *height_px = picture.height;
    write_array(std::span<const Rgb>(picture.pixels), rgb, capacity, needed, sizeof(Rgb));
  });
}

roomradar_status roomradar_session_view(roomradar_session* session, roomradar_camera* camera,
                                        roomradar_pose* T_world_view) {
  return with<SessionState>("roomradar_session_view", session, [&](SessionState& state) {
    require_given(camera, "camera");
    require_given(T_world_view, "T_world_view");
    const std::optional<ShownView>& view = state.session->shown_view();
    if (!view)
      throw Refusal(ROOMRADAR_FAILED,
                    "no picture with a pose: the last frame was not located, or none was made");
    *camera = camera_of(view->camera);
    *T_world_view = pose_of(view->T_world_view);
  });
}

roomradar_status roomradar_session_notices(roomradar_session* session, char* text, size_t capacity,
                                           size_t* needed) {
  return with<SessionState>("roomradar_session_notices", session, [&](SessionState& state) {
    state.run([&](Session& live) { state.keep(live.take_notices()); });
    std::string lines;
    for (const std::string& notice : state.notices) lines += notice + "\n";
    write_text(lines, text, capacity, needed);
    state.notices.clear();
  });
}

roomradar_status roomradar_session_set_unknown(roomradar_session* session, int32_t is_solid) {
  return with<SessionState>("roomradar_session_set_unknown", session, [&](SessionState& state) {
    state.run([&](Session& live) {
      if (is_solid != 0)
        live.make_unknown_solid(state.times);
      else
        live.make_unknown_free();
    });
  });
}

roomradar_status roomradar_session_set_surfaces(roomradar_session* session, int32_t surfaces) {
  return with<SessionState>("roomradar_session_set_surfaces", session, [&](SessionState& state) {
    const SurfacePolicy policy = surfaces_of(surfaces);
    state.run([&](Session& live) { live.set_surfaces(policy); });
  });
}

roomradar_status roomradar_session_set_quality(roomradar_session* session, const char* quality) {
  return with<SessionState>("roomradar_session_set_quality", session, [&](SessionState& state) {
    require_given(quality, "quality");
    const RunQuality wanted = quality_of(quality);
    state.run([&](Session& live) { live.set_quality(wanted); });
  });
}
