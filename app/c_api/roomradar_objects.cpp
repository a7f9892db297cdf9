// roomradar_objects.cpp: exported functions for the virtual objects of a session.
#include "app/c_api/roomradar_objects.h"

#include <algorithm>
#include <string>
#include <utility>

#include "app/c_api/conversions.hpp"
#include "app/c_api/session_state.hpp"
#include "app/objects/object_file.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

namespace {

BodyMaterial material_of(const roomradar_material* material) {
  const auto given = options_of(material, "material");
  constexpr uint32_t kAll =
      ROOMRADAR_SETS_MASS | ROOMRADAR_SETS_DENSITY | ROOMRADAR_SETS_FRICTION | ROOMRADAR_SETS_RESTITUTION;
  if ((given.is_set & ~kAll) != 0)
    refuse("material.is_set = " + std::to_string(given.is_set) + ": must be a sum of ROOMRADAR_SETS_ values");
  BodyMaterial made;
  if ((given.is_set & ROOMRADAR_SETS_MASS) != 0) made.mass_kg = given.mass_kg;
  if ((given.is_set & ROOMRADAR_SETS_DENSITY) != 0) made.density_kg_m3 = given.density_kg_m3;
  if ((given.is_set & ROOMRADAR_SETS_FRICTION) != 0) made.friction = given.friction;
  if ((given.is_set & ROOMRADAR_SETS_RESTITUTION) != 0) made.restitution = given.restitution;
  require_valid(made);
  return made;
}

/// Returns a name that no object has.
std::string new_name_of(const char* name, const SessionState& state) {
  const std::string named = name_of(name);
  if (find_object(state.session->objects(), named) != nullptr)
    refuse("an object named " + named + " already exists");
  return named;
}

void add(SessionState& state, const std::string& name, ObjectParts parts, const BodyMaterial& material) {
  state.run([&](Session& live) { live.add_object(name, std::move(parts), material); });
}

ObjectState state_of(const roomradar_pose* T_world_object) {
  const Eigen::Isometry3d T = pose_of(T_world_object, "T_world_object");
  ObjectState state;
  state.position_world = T.translation();
  state.R_world_object = T.linear();
  return state;
}

roomradar_object_state state_of(const VirtualObject& object) {
  const Body& body = object.body;
  roomradar_object_state state{};
  state.is_in_room = object.in_room ? 1 : 0;
  state.is_asleep = body.asleep ? 1 : 0;
  state.is_carried = object.carried_to_world ? 1 : 0;
  state.is_stuck = object.placement.stuck ? 1 : 0;
  state.rests_on = static_cast<int32_t>(body.rests_on);
  state.departures = object.departures;
  state.mass_kg = body.mass.mass_kg;
  state.T_world_object = pose_of(body.T_world_object);
  write_vector(body.velocity_world_mps, state.velocity_world_mps);
  write_vector(body.angular_velocity_world_rad_s, state.angular_velocity_world_rad_s);
  return state;
}

/// Calls work(SessionState&) if the session has an object of that name.
template <typename Work>
roomradar_status with_object(const char* call, roomradar_session* session, const char* name,
                             const Work& work) {
  return with<SessionState>(call, session, [&](SessionState& state) {
    static_cast<void>(state.object(name));
    work(state);
  });
}

}  // namespace

roomradar_status roomradar_session_add_file(roomradar_session* session, const char* name, const char* file,
                                            double size_m, const roomradar_material* material) {
  return with<SessionState>("roomradar_session_add_file", session, [&](SessionState& state) {
    const std::string named = new_name_of(name, state);
    const BodyMaterial of = material_of(material);
    ObjectSource source{.mesh = text_of(file, "file")};
    if (!(size_m >= 0.0 && size_m <= 100.0)) refuse("size_m: must be in 0..100 m");
    if (size_m > 0.0) source.size_m = size_m;
    Model model = object_model(source);
    require_sensible_size(model, source, {state.session->room_extent_m(), "size_m = "});
    add(state, named, object_parts(named, std::move(model)), of);
  });
}

roomradar_status roomradar_session_add_mesh(roomradar_session* session, const char* name,
                                            const roomradar_mesh* mesh, const roomradar_material* material) {
  return with<SessionState>("roomradar_session_add_mesh", session, [&](SessionState& state) {
    const std::string named = new_name_of(name, state);
    const BodyMaterial of = material_of(material);
    add(state, named, object_parts(named, mesh_of(mesh)), of);
  });
}

roomradar_status roomradar_session_set_material(roomradar_session* session, const char* name,
                                                const roomradar_material* material) {
  return with_object("roomradar_session_set_material", session, name, [&](SessionState& state) {
    require_given(material, "material");
    const BodyMaterial change = material_of(material);
    state.run([&](Session& live) { live.set_material(name, change); });
  });
}

roomradar_status roomradar_session_place(roomradar_session* session, const char* name,
                                         const roomradar_pose* T_world_object) {
  return with_object("roomradar_session_place", session, name, [&](SessionState& state) {
    const ObjectState placed = state_of(T_world_object);
    state.run([&](Session& live) { live.place(name, placed); });
  });
}

roomradar_status roomradar_session_throw(roomradar_session* session, const char* name,
                                         const roomradar_pose* T_world_object,
                                         const double velocity_world_mps[3],
                                         const double angular_velocity_world_rad_s[3]) {
  return with_object("roomradar_session_throw", session, name, [&](SessionState& state) {
    ObjectState thrown = state_of(T_world_object);
    thrown.velocity_world_mps = vector_of(velocity_world_mps, "velocity_world_mps");
    if (angular_velocity_world_rad_s != nullptr)
      thrown.angular_velocity_world_rad_s =
          vector_of(angular_velocity_world_rad_s, "angular_velocity_world_rad_s");
    state.run([&](Session& live) { live.throw_object(name, thrown); });
  });
}

roomradar_status roomradar_session_drop(roomradar_session* session, const char* name,
                                        const double point_world_m[3], double height_m) {
  return with_object("roomradar_session_drop", session, name, [&](SessionState& state) {
    if (!(height_m >= 0.0 && height_m <= 100.0)) refuse("height_m: must be in 0..100 m");
    DropRequest drop{.name = name, .height_m = height_m};
    if (point_world_m != nullptr) drop.position_world = vector_of(point_world_m, "point_world_m");
    state.run([&](Session& live) { live.drop(drop); });
  });
}

roomradar_status roomradar_session_carry(roomradar_session* session, const char* name,
                                         const double position_world_m[3]) {
  return with_object("roomradar_session_carry", session, name, [&](SessionState& state) {
    const Eigen::Vector3d to = vector_of(position_world_m, "position_world_m");
    state.run([&](Session& live) { live.carry(name, to); });
  });
}

roomradar_status roomradar_session_release(roomradar_session* session, const char* name,
                                           const double velocity_world_mps[3]) {
  return with_object("roomradar_session_release", session, name, [&](SessionState& state) {
    const Eigen::Vector3d velocity = vector_of(velocity_world_mps, "velocity_world_mps");
    state.run([&](Session& live) { live.release(name, velocity); });
  });
}

roomradar_status roomradar_session_turn(roomradar_session* session, const char* name,
                                        const double turn_world_deg[3]) {
  return with_object("roomradar_session_turn", session, name, [&](SessionState& state) {
    const Eigen::Vector3d turn = vector_of(turn_world_deg, "turn_world_deg");
    state.run([&](Session& live) { live.turn(name, turn); });
  });
}

roomradar_status roomradar_session_remove(roomradar_session* session, const char* name) {
  return with_object("roomradar_session_remove", session, name,
                     [&](SessionState& state) { state.run([&](Session& live) { live.remove(name); }); });
}

roomradar_status roomradar_session_objects(roomradar_session* session, roomradar_object_state* states,
                                           size_t capacity, size_t* needed) {
  return with<SessionState>("roomradar_session_objects", session, [&](SessionState& state) {
    const auto& objects = state.session->objects();
    require_capacity(states, capacity, objects.size(), needed);
    for (const auto& object : objects) *states++ = state_of(*object);
  });
}

roomradar_status roomradar_session_object(roomradar_session* session, const char* name,
                                          roomradar_object_state* state) {
  return with<SessionState>("roomradar_session_object", session, [&](SessionState& session_state) {
    require_given(state, "state");
    *state = state_of(session_state.object(name));
  });
}

roomradar_status roomradar_session_object_name(roomradar_session* session, size_t index, char* name,
                                               size_t capacity, size_t* needed) {
  return with<SessionState>("roomradar_session_object_name", session, [&](SessionState& state) {
    const auto& objects = state.session->objects();
    if (index >= objects.size())
      refuse("index = " + std::to_string(index) + ": there are " + std::to_string(objects.size()) +
             " objects");
    write_text(objects[index]->body.name, name, capacity, needed);
  });
}

roomradar_status roomradar_session_object_mesh(roomradar_session* session, const char* name,
                                               roomradar_mesh_buffers* mesh) {
  return with<SessionState>("roomradar_session_object_mesh", session, [&](SessionState& state) {
    write_mesh(state.object(name).model->source.mesh, 1, mesh);
  });
}

roomradar_status roomradar_session_touches(roomradar_session* session, const char* name,
                                           roomradar_touch* touches, size_t capacity, size_t* needed) {
  return with<SessionState>("roomradar_session_touches", session, [&](SessionState& state) {
    const VirtualObject& object = state.object(name);
    const auto& objects = state.session->objects();
    const std::size_t count = object.in_room ? object.contacts.size() : 0;
    require_capacity(touches, capacity, count, needed);
    for (std::size_t i = 0; i < count; ++i) {
      const ObjectContact& contact = object.contacts[i];
      const auto other = std::find_if(objects.begin(), objects.end(),
                                      [&](const auto& one) { return &one->body == contact.other; });
      write_vector(contact.closest.point_world, touches[i].point_world);
      write_vector(contact.closest.normal_world, touches[i].normal_world);
      touches[i].gap_m = contact.closest.gap_m;
      touches[i].kind = static_cast<int32_t>(contact.closest.kind);
      touches[i].other = other == objects.end() ? -1 : static_cast<int32_t>(other - objects.begin());
    }
  });
}
