// roomradar_radar.cpp: exported functions for radar queries.
#include "app/c_api/roomradar_radar.h"

#include <span>
#include <utility>
#include <vector>

#include "app/c_api/conversions.hpp"
#include "app/c_api/session_state.hpp"
#include "radar/exact/scene_boxes.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

static_assert(static_cast<int>(ContactStatus::kInvalidInput) == ROOMRADAR_CONTACT_INVALID &&
              static_cast<int>(ContactStatus::kNoAnswer) == ROOMRADAR_CONTACT_NO_ANSWER &&
              static_cast<int>(ContactStatus::kNoTarget) == ROOMRADAR_CONTACT_NONE &&
              static_cast<int>(ContactStatus::kContact) == ROOMRADAR_CONTACT_TOUCHES &&
              static_cast<int>(ContactStatus::kOverlap) == ROOMRADAR_CONTACT_OVERLAP);
static_assert(static_cast<int>(SurfaceKind::kStatic) == ROOMRADAR_SURFACE_STATIC &&
              static_cast<int>(SurfaceKind::kDynamic) == ROOMRADAR_SURFACE_DYNAMIC &&
              static_cast<int>(SurfaceKind::kObject) == ROOMRADAR_SURFACE_OBJECT &&
              static_cast<int>(SurfaceKind::kUnknownFrontier) == ROOMRADAR_SURFACE_UNKNOWN_FRONTIER &&
              static_cast<int>(SurfaceKind::kInferredBack) == ROOMRADAR_SURFACE_INFERRED_BACK &&
              kSurfaceKinds == ROOMRADAR_SURFACE_KINDS);

namespace {

struct RadarState : Handled {
  static constexpr const char* kKind = "radar";
  CyberRadar radar;
  std::vector<std::shared_ptr<const ShapeState>> shapes;  ///< keeps the trees of `trees`
  std::vector<SceneTree> trees;
  SceneBoxes boxes;  ///< of `trees`, if there are many
};
constexpr std::size_t kManyTrees = 32;

/// Runs queries one after the other.
void query_all(CyberRadar& radar, const RadarScene& scene, const TriangleTree& object,
               std::span<const roomradar_query> queries, roomradar_contact* contacts) {
  RadarQuery query;
  query.object.tree = &object;
  for (const roomradar_query& asked : queries) {
    Contact found;  // unset: invalid
    if (is_pose(asked.T_world_object)) {
      query.object.T_world_mesh = unchecked_pose_of(asked.T_world_object);
      query.direction_world = Eigen::Map<const Eigen::Vector3d>(asked.direction_world);
      query.distance_m = asked.distance_m;
      query.margin_m = asked.margin_m;
      found = radar.query(query, scene);
    }
    roomradar_contact& contact = *contacts++;
    contact.status = static_cast<int32_t>(found.status);
    contact.kind = static_cast<int32_t>(found.touched);
    contact.travel_m = found.contact_distance_m;
    contact.lower_m = found.lower_m;
    contact.upper_m = found.upper_m;
    write_vector(found.point_world, contact.point_world);
    write_vector(found.normal_world, contact.normal_world);
  }
}

std::span<const roomradar_query> queries_of(const roomradar_query* queries, size_t count,
                                            const roomradar_contact* contacts) {
  if (count == 0) return {};
  require_given(queries, "queries");
  require_given(contacts, "contacts");
  return {queries, count};
}

RadarScene scene_of(const RadarState& state) {
  return {state.trees, {}, state.trees.size() >= kManyTrees ? &state.boxes : nullptr};
}

}  // namespace

roomradar_status roomradar_shape_open(const roomradar_mesh* mesh, roomradar_shape** shape) {
  return guarded("roomradar_shape_open", nullptr, [&] {
    require_given(shape, "shape");
    auto state = std::make_shared<ShapeState>();
    state->tree.build_by_place(mesh_of(mesh));
    *shape = HandleTable<ShapeState>::get().add<roomradar_shape>(std::move(state));
  });
}

roomradar_status roomradar_shape_close(roomradar_shape* shape) {
  return c_api::close<ShapeState>("roomradar_shape_close", shape);
}

roomradar_status roomradar_radar_open(const roomradar_radar_options* options, roomradar_radar** radar) {
  return guarded("roomradar_radar_open", nullptr, [&] {
    require_given(radar, "radar");
    const auto wanted = options_of(options, "options");
    RadarConfig config;
    if (wanted.is_sampled != 0) config.mode = RadarMode::kSampled;
    if (wanted.resolution_px != 0) config.resolution_px = wanted.resolution_px;
    auto state = std::make_shared<RadarState>();
    state->radar = CyberRadar(config);
    *radar = HandleTable<RadarState>::get().add<roomradar_radar>(std::move(state));
  });
}

roomradar_status roomradar_radar_close(roomradar_radar* radar) {
  return c_api::close<RadarState>("roomradar_radar_close", radar);
}

const char* roomradar_radar_error(const roomradar_radar* radar) { return error_of<RadarState>(radar); }

roomradar_status roomradar_radar_set_scene(roomradar_radar* radar, const roomradar_placed_shape* shapes,
                                           size_t count) {
  return with<RadarState>("roomradar_radar_set_scene", radar, [&](RadarState& state) {
    if (count > 0) require_given(shapes, "shapes");
    std::vector<std::shared_ptr<const ShapeState>> kept;
    std::vector<SceneTree> trees;
    for (const roomradar_placed_shape& placed : std::span(shapes, count)) {
      if (placed.kind <= ROOMRADAR_SURFACE_NOTHING || placed.kind >= ROOMRADAR_SURFACE_KINDS)
        refuse("shapes[" + std::to_string(kept.size()) + "].kind = " + std::to_string(placed.kind) +
               ": must be in 1..5");
      kept.push_back(object_of<ShapeState>(placed.shape));
      trees.push_back({{&kept.back()->tree, pose_of(&placed.T_world_shape, "T_world_shape")},
                       static_cast<SurfaceKind>(placed.kind)});
    }
    state.shapes = std::move(kept);
    state.trees = std::move(trees);
    state.boxes.build(state.trees);
  });
}

roomradar_status roomradar_radar_query(roomradar_radar* radar, const roomradar_shape* object,
                                       const roomradar_query* query, roomradar_contact* contact) {
  return roomradar_radar_query_many(radar, object, query, 1, contact);
}

roomradar_status roomradar_radar_query_many(roomradar_radar* radar, const roomradar_shape* object,
                                            const roomradar_query* queries, size_t count,
                                            roomradar_contact* contacts) {
  return with<RadarState>("roomradar_radar_query_many", radar, [&](RadarState& state) {
    const std::shared_ptr<const ShapeState> shape = object_of<ShapeState>(object);
    query_all(state.radar, scene_of(state), shape->tree, queries_of(queries, count, contacts), contacts);
  });
}

roomradar_status roomradar_session_query_shape(roomradar_session* session, const roomradar_shape* object,
                                               const roomradar_query* queries, size_t count,
                                               roomradar_contact* contacts) {
  return with<SessionState>("roomradar_session_query_shape", session, [&](SessionState& state) {
    const std::shared_ptr<const ShapeState> shape = object_of<ShapeState>(object);
    const std::vector<SceneTree> scene = state.session->scene_without(nullptr);
    query_all(state.radar, {scene, {}}, shape->tree, queries_of(queries, count, contacts), contacts);
  });
}

roomradar_status roomradar_session_query_object(roomradar_session* session, const char* name,
                                                const roomradar_query* queries, size_t count,
                                                roomradar_contact* contacts) {
  return with<SessionState>("roomradar_session_query_object", session, [&](SessionState& state) {
    const VirtualObject& object = state.object(name);
    const std::vector<SceneTree> scene = state.session->scene_without(&object);
    query_all(state.radar, {scene, {}}, object.model->shape.touched, queries_of(queries, count, contacts),
              contacts);
  });
}
