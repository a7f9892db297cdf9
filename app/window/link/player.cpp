// player.cpp: casts rays through pixels and makes events of commands.
#include "app/window/link/player.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "app/session/script/session_events.hpp"

namespace roomradar {
namespace {

constexpr double kReach_m = 50.0;
constexpr double kOverSurface_m = 0.002;  // initial gap of a placed object: touching would count as overlap
constexpr double kThrownFrom_m = 0.35;    // in front of the camera
constexpr double kNearest_m = 0.25;       // min distance of carried objects
constexpr double kFastest_mps = 15.0;

ScriptEvent event_of(Action action, const std::string& name) {
  ScriptEvent event;
  event.action = action;
  event.name = name;
  return event;
}

/// Removes and returns the release of an object carried in the same events, and its later events. They are
/// applied one frame later: a carry that is released at once would not move the object.
std::vector<ScriptEvent> take_held_back(std::vector<ScriptEvent>& events) {
  std::set<std::string> carried, let_go;
  std::vector<ScriptEvent> now, later;
  for (ScriptEvent& event : events) {
    if (event.action == Action::kCarry) carried.insert(event.name);
    if (event.action == Action::kRelease && carried.contains(event.name)) let_go.insert(event.name);
    (let_go.contains(event.name) ? later : now).push_back(std::move(event));
  }
  events = std::move(now);
  return later;
}

}  // namespace

Pointed pointed_at(const Session& session, const Eigen::Vector2d& pixel) {
  Pointed pointed;
  if (!session.shown_view()) return pointed;
  const Ray ray =
      ray_through(session.shown_view()->camera, session.shown_view()->T_world_view, pixel.x(), pixel.y());
  double reach_m = kReach_m;
  for (const SceneTree& surface : session.scene_without(nullptr)) {
    if (surface.kind != SurfaceKind::kStatic && surface.kind != SurfaceKind::kDynamic)
      continue;  // not visible
    const auto hit = hit_mesh(surface.instance, ray, reach_m);
    if (!hit) continue;
    pointed.surface = hit;
    reach_m = hit->distance_m;
  }
  for (const auto& object : session.objects()) {
    if (!object->in_room) continue;
    const auto hit = hit_mesh({&object->model->shape.touched, object->body.T_world_object}, ray, reach_m);
    if (!hit) continue;
    pointed.object = hit;
    pointed.name = object->body.name;
    reach_m = hit->distance_m;
  }
  return pointed;
}

Eigen::Vector3d turn_of_drag_world_deg(const Eigen::Matrix3d& R_world_view, const Eigen::Vector2d& way_px) {
  constexpr double kTurn_deg_per_px = 0.5;
  // If the camera looks straight down, a rotation about the vertical moves nothing sideways in the picture.
  constexpr double kLeastUpright = 0.3;
  const Eigen::Vector3d right = R_world_view.col(0), up = -R_world_view.col(1);
  const Eigen::Vector3d upright =
      std::abs(up.z()) > kLeastUpright ? Eigen::Vector3d(0.0, 0.0, std::copysign(1.0, up.z())) : up;
  // The object's front is at -z of the camera's axes: a rotation about x moves it along y, down; one about -y
  // moves it along x, right.
  return kTurn_deg_per_px * (way_px.x() * upright + way_px.y() * right);
}

std::vector<ScriptEvent> Player::events_of(std::span<const UserCommand> commands, const Session& session) {
  std::vector<ScriptEvent> events = std::exchange(held_back_, {});
  complaint_.clear();
  choose_if_none(session);
  for (const UserCommand& command : commands) {
    switch (command.kind) {
      case UserCommandKind::kEvent:
        events.push_back(command.event);
        break;
      case UserCommandKind::kDrop:
      case UserCommandKind::kPlace:
        drop_or_place(command, session, events);
        break;
      case UserCommandKind::kThrow:
        throw_chosen(command, session, events);
        break;
      case UserCommandKind::kGrab:
        grab(command, session);
        break;
      case UserCommandKind::kDrag:
        drag(command, session, events);
        break;
      case UserCommandKind::kLetGo:
        let_go(command, session, events);
        break;
      case UserCommandKind::kTurn: {
        const std::string& name = grabbed_ ? grabbed_->name : chosen_;
        if (name.empty()) break;
        events.push_back(command.event);
        events.back().action = Action::kTurn;
        events.back().name = name;
        break;
      }
      case UserCommandKind::kChoose:
        if (find_object(session.objects(), command.event.name) != nullptr) chosen_ = command.event.name;
        break;
      case UserCommandKind::kNew:
        add(command, session, events);
        break;
      case UserCommandKind::kRemove:
        if (!chosen_.empty()) events.push_back(event_of(Action::kRemove, chosen_));
        if (grabbed_ && grabbed_->name == chosen_) grabbed_.reset();
        break;
      case UserCommandKind::kReset:
        for (const auto& object : session.objects())  // also objects outside the room, to cancel waiting
                                                      // drops
          events.push_back(event_of(Action::kRemove, object->body.name));
        if (!chosen_.empty()) events.push_back(event_of(Action::kDrop, chosen_));
        grabbed_.reset();
        break;
    }
  }
  held_back_ = take_held_back(events);
  return events;
}

void Player::choose_if_none(const Session& session) {
  if (find_object(session.objects(), chosen_) != nullptr) return;
  chosen_ = session.objects().empty() ? "" : session.objects().front()->body.name;
}

void Player::add(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events) {
  const std::string& mesh = command.event.mesh;
  const std::string stem = object_name(mesh);
  std::string name = stem;
  for (int number = 2; find_object(session.objects(), name) != nullptr; ++number)
    name = stem + std::to_string(number);
  ScriptEvent event = event_of(Action::kAdd, name);
  event.mesh = mesh;
  event.size_m = command.event.size_m;
  event.up = command.event.up;
  events.push_back(event);
  events.push_back(event_of(Action::kDrop, name));
  chosen_ = name;
}

void Player::drop_or_place(const UserCommand& command, const Session& session,
                           std::vector<ScriptEvent>& events) {
  const VirtualObject* object = find_object(session.objects(), chosen_);
  const Pointed pointed = pointed_at(session, command.pixel);
  // On top of another object if the pixel shows one.
  const auto& hit = pointed.object && pointed.name != chosen_ ? pointed.object : pointed.surface;
  if (object == nullptr || !hit) {
    complaint_ = object == nullptr       ? "there is no object to drop: choose one"
                 : !session.shown_view() ? "the camera is not located"
                                         : "there is no surface at that place";
    return;
  }
  ScriptEvent event =
      event_of(command.kind == UserCommandKind::kPlace ? Action::kPlace : Action::kDrop, chosen_);
  event.height_m = command.event.height_m;
  const bool is_on_object = &hit == &pointed.object;
  if (command.kind != UserCommandKind::kPlace && !is_on_object) {
    event.near_world = hit->point_world;
  } else {
    event.position_world = hit->point_world - level_to_middle(*object, object->body.T_world_object.linear());
    if (command.kind == UserCommandKind::kPlace)
      event.position_world->z() += kOverSurface_m - lowest_m(*object);
  }
  events.push_back(event);
}

void Player::throw_chosen(const UserCommand& command, const Session& session,
                          std::vector<ScriptEvent>& events) {
  const VirtualObject* object = find_object(session.objects(), chosen_);
  if (object == nullptr || !session.shown_view()) {
    complaint_ = "there is nothing to throw, or the camera is not located";
    return;
  }
  const Ray ray = ray_through(session.shown_view()->camera, session.shown_view()->T_world_view,
                              command.pixel.x(), command.pixel.y());
  ScriptEvent event = event_of(Action::kThrow, chosen_);
  event.position_world = ray.origin_world + kThrownFrom_m * ray.direction_world -
                         object->body.T_world_object.linear() * object->model->middle;
  event.velocity_world_mps = std::min(command.speed_mps, kFastest_mps) * ray.direction_world;
  events.push_back(event);
}

void Player::grab(const UserCommand& command, const Session& session) {
  const Pointed pointed = pointed_at(session, command.pixel);
  grabbed_.reset();
  if (!pointed.object) return;
  chosen_ = pointed.name;
  const VirtualObject& object = *find_object(session.objects(), chosen_);
  grabbed_ = {chosen_, pointed.object->distance_m, middle_world(object) - pointed.object->point_world, false};
}

void Player::drag(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events) {
  const VirtualObject* object = grabbed_ ? find_object(session.objects(), grabbed_->name) : nullptr;
  if (object == nullptr || !session.shown_view()) return;
  const Ray ray = ray_through(session.shown_view()->camera, session.shown_view()->T_world_view,
                              command.pixel.x(), command.pixel.y());
  const double distance_m = std::max(grabbed_->distance_m - command.nearer_m, kNearest_m);
  ScriptEvent event = event_of(Action::kCarry, grabbed_->name);
  event.position_world = ray.origin_world + distance_m * ray.direction_world + grabbed_->middle_from_point -
                         object->body.T_world_object.linear() * object->model->middle;
  events.push_back(event);
  grabbed_->is_carried = true;
}

void Player::let_go(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events) {
  if (!grabbed_) {
    if (!command.was_dragged) drop_or_place(command, session, events);
    return;
  }
  const Grabbed grabbed = *grabbed_;
  grabbed_.reset();
  if (!grabbed.is_carried) return;
  ScriptEvent event = event_of(Action::kRelease, grabbed.name);
  if (session.shown_view()) {
    // The mouse's speed, at the distance of the grabbed point.
    constexpr double kLately_s = 0.05;
    const auto& [camera, T_world_view] = *session.shown_view();
    const Eigen::Vector2d before = command.pixel - kLately_s * command.pixel_velocity_s;
    const double distance_m = std::max(grabbed.distance_m - command.nearer_m, kNearest_m);
    const Eigen::Vector3d way =
        distance_m *
        (ray_through(camera, T_world_view, command.pixel.x(), command.pixel.y()).direction_world -
         ray_through(camera, T_world_view, before.x(), before.y()).direction_world);
    const double speed_mps = way.norm() / kLately_s;
    if (std::isfinite(speed_mps) && speed_mps > 0.0)
      event.velocity_world_mps = way / kLately_s * std::min(1.0, kFastest_mps / speed_mps);
  }
  events.push_back(event);
}

}  // namespace roomradar
