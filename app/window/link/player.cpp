// player.cpp: casts rays through pixels and makes events of commands.
#include "app/window/link/player.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "app/session/script/session_events.hpp"
#include "mapping/types/system/overloaded.hpp"

namespace roomradar {
namespace {

constexpr double kReach_m = 50.0;
constexpr double kOverSurface_m = 0.002;  // initial gap of a placed object: touching would count as overlap
constexpr double kThrownFrom_m = 0.35;    // in front of the camera
constexpr double kNearest_m = 0.25;       // min distance of carried objects
constexpr double kFastest_mps = 15.0;

/// Removes and returns the release of an object carried in the same events, and its later events. They are
/// applied one frame later: a carry that is released at once would not move the object.
std::vector<ScriptEvent> take_held_back(std::vector<ScriptEvent>& events) {
  std::set<std::string> carried, let_go;
  std::vector<ScriptEvent> now, later;
  for (ScriptEvent& event : events) {
    const std::string name = object_of(event.action);
    if (std::holds_alternative<CarryObject>(event.action)) carried.insert(name);
    if (std::holds_alternative<ReleaseObject>(event.action) && carried.contains(name)) let_go.insert(name);
    (let_go.contains(name) ? later : now).push_back(std::move(event));
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
  for (const UserCommand& command : commands)
    std::visit(overloaded{
                   [&](const Action& action) { events.push_back({action}); },
                   [&](const DropChosen& drop) { drop_chosen(drop.pixel, drop.height_m, session, events); },
                   [&](const PlaceChosen& place) { place_chosen(place, session, events); },
                   [&](const ThrowChosen& thrown) { throw_chosen(thrown, session, events); },
                   [&](const GrabObject& grabbed) { grab(grabbed, session); },
                   [&](const DragGrabbed& dragged) { drag(dragged, session, events); },
                   [&](const LetGo& released) { let_go(released, session, events); },
                   [&](const TurnGrabbed& turn) {
                     const std::string& name = grabbed_ ? grabbed_->name : chosen_;
                     if (!name.empty()) events.push_back({TurnObject{name, turn.turn_world_deg}});
                   },
                   [&](const ChooseObject& object) {
                     if (find_object(session.objects(), object.name) != nullptr) chosen_ = object.name;
                   },
                   [&](const AddNew& object) { add(object, session, events); },
                   [&](const RemoveChosen&) {
                     if (!chosen_.empty()) events.push_back({RemoveObject{chosen_}});
                     if (grabbed_ && grabbed_->name == chosen_) grabbed_.reset();
                   },
                   [&](const ResetObjects&) {
                     for (const auto& object : session.objects())  // also objects outside the room, to cancel
                                                                   // waiting drops
                       events.push_back({RemoveObject{object->body.name}});
                     if (!chosen_.empty()) events.push_back({DropObject{.name = chosen_}});
                     grabbed_.reset();
                   },
               },
               command);
  held_back_ = take_held_back(events);
  return events;
}

void Player::choose_if_none(const Session& session) {
  if (find_object(session.objects(), chosen_) != nullptr) return;
  chosen_ = session.objects().empty() ? "" : session.objects().front()->body.name;
}

void Player::add(const AddNew& object, const Session& session, std::vector<ScriptEvent>& events) {
  const std::string stem = object_name(object.source.mesh);
  std::string name = stem;
  for (int number = 2; find_object(session.objects(), name) != nullptr; ++number)
    name = stem + std::to_string(number);
  events.push_back({AddObject{.name = name, .source = object.source}});
  events.push_back({DropObject{.name = name}});
  chosen_ = name;
}

std::optional<Player::Target> Player::target_at(const Eigen::Vector2d& pixel, const Session& session) {
  const VirtualObject* object = find_object(session.objects(), chosen_);
  const Pointed pointed = pointed_at(session, pixel);
  const bool is_on_object = pointed.object && pointed.name != chosen_;
  const auto& hit = is_on_object ? pointed.object : pointed.surface;
  if (object == nullptr || !hit) {
    complaint_ = object == nullptr       ? "there is no object to drop: choose one"
                 : !session.shown_view() ? "the camera is not located"
                                         : "there is no surface at that place";
    return std::nullopt;
  }
  return Target{object, hit->point_world,
                hit->point_world - level_to_middle(*object, object->body.T_world_object.linear()),
                is_on_object};
}

void Player::drop_chosen(const Eigen::Vector2d& pixel, double height_m, const Session& session,
                         std::vector<ScriptEvent>& events) {
  const auto target = target_at(pixel, session);
  if (!target) return;
  DropObject drop{.name = chosen_, .height_m = height_m};
  if (target->is_on_object)
    drop.position_world = target->position_world;
  else
    drop.near_world = target->point_world;
  events.push_back({drop});
}

void Player::place_chosen(const PlaceChosen& place, const Session& session,
                          std::vector<ScriptEvent>& events) {
  const auto target = target_at(place.pixel, session);
  if (!target) return;
  PlaceObject placed{.name = chosen_, .position_world = target->position_world};
  placed.position_world.z() += kOverSurface_m - lowest_m(*target->object);
  events.push_back({placed});
}

void Player::throw_chosen(const ThrowChosen& command, const Session& session,
                          std::vector<ScriptEvent>& events) {
  const VirtualObject* object = find_object(session.objects(), chosen_);
  if (object == nullptr || !session.shown_view()) {
    complaint_ = "there is nothing to throw, or the camera is not located";
    return;
  }
  const Ray ray = ray_through(session.shown_view()->camera, session.shown_view()->T_world_view,
                              command.pixel.x(), command.pixel.y());
  ThrowObject thrown{.name = chosen_};
  thrown.position_world = ray.origin_world + kThrownFrom_m * ray.direction_world -
                          object->body.T_world_object.linear() * object->model->middle;
  thrown.velocity_world_mps = std::min(command.speed_mps, kFastest_mps) * ray.direction_world;
  events.push_back({thrown});
}

void Player::grab(const GrabObject& command, const Session& session) {
  const Pointed pointed = pointed_at(session, command.pixel);
  grabbed_.reset();
  if (!pointed.object) return;
  chosen_ = pointed.name;
  const VirtualObject& object = *find_object(session.objects(), chosen_);
  grabbed_ = {chosen_, pointed.object->distance_m, middle_world(object) - pointed.object->point_world, false};
}

void Player::drag(const DragGrabbed& command, const Session& session, std::vector<ScriptEvent>& events) {
  const VirtualObject* object = grabbed_ ? find_object(session.objects(), grabbed_->name) : nullptr;
  if (object == nullptr || !session.shown_view()) return;
  const Ray ray = ray_through(session.shown_view()->camera, session.shown_view()->T_world_view,
                              command.pixel.x(), command.pixel.y());
  const double distance_m = std::max(grabbed_->distance_m - command.nearer_m, kNearest_m);
  CarryObject carry{.name = grabbed_->name};
  carry.position_world = ray.origin_world + distance_m * ray.direction_world + grabbed_->middle_from_point -
                         object->body.T_world_object.linear() * object->model->middle;
  events.push_back({carry});
  grabbed_->is_carried = true;
}

void Player::let_go(const LetGo& command, const Session& session, std::vector<ScriptEvent>& events) {
  if (!grabbed_) {
    if (!command.was_dragged) drop_chosen(command.pixel, command.height_m, session, events);
    return;
  }
  const Grabbed grabbed = *grabbed_;
  grabbed_.reset();
  if (!grabbed.is_carried) return;
  ReleaseObject release{.name = grabbed.name};
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
      release.velocity_world_mps = way / kLately_s * std::min(1.0, kFastest_mps / speed_mps);
  }
  events.push_back({release});
}

}  // namespace roomradar
