// session_events.cpp: one typed call of Session per kind of event.
#include "app/session/script/session_events.hpp"

#include <Eigen/Geometry>
#include <cctype>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "mapping/types/system/overloaded.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {
namespace {

/// Returns the orientation for yaw, pitch and roll: about z, then the rotated y axis, then the rotated x
/// axis.
std::optional<Eigen::Matrix3d> R_world_object_of(const std::optional<Eigen::Vector3d>& turned_deg) {
  if (!turned_deg) return std::nullopt;
  const Eigen::Vector3d angles = *turned_deg * (std::numbers::pi / 180.0);
  return (Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Returns the text that a user's script or command line needs before a size.
std::string option_before_size(const AddObject& add, int line) {
  if (line > 0) return "add " + add.name + " " + add.source.mesh + " size ";
  return add.name == kOnlyObject ? "--object-size " : "--object " + add.source.mesh + ",size=";
}

void require_sensible_size(const Session& session, const AddObject& add, int line, const Model& model) {
  require_sensible_size(model, add.source, {session.room_extent_m(), option_before_size(add, line)});
}

void add_object(Session& session, const AddObject& add, int line) {
  Model model = object_model(add.source);
  require_sensible_size(session, add, line, model);
  session.add_object(add.name, std::move(model), add.material);
}

void set_unknown(Session& session, const SetUnknown& set) {
  StageTimes unreported;
  if (set.is_solid)
    session.make_unknown_solid(unreported);
  else
    session.make_unknown_free();
}

}  // namespace

void add_object(Session& session, const AddObject& add, int line, ObjectParts parts) {
  require_sensible_size(session, add, line, parts.source);
  session.add_object(add.name, std::move(parts), add.material);
}

std::string object_name(const std::string& mesh) {
  std::string stem = mesh.substr(mesh.find_last_of('/') + 1);
  stem = stem.substr(0, stem.find('.'));
  for (char& letter : stem)
    if (std::isspace(static_cast<unsigned char>(letter)) != 0 || letter == '#') letter = '_';
  return stem.empty() ? "object" : stem;
}

void apply(Session& session, const ScriptEvent& event) {
  std::visit(
      overloaded{
          [&](const AddObject& add) { add_object(session, add, event.line); },
          [&](const PlaceObject& place) {
            session.place(place.name, {.position_world = place.position_world,
                                       .R_world_object = R_world_object_of(place.turned_deg)});
          },
          [&](const StandObject& stand) {
            session.stand(stand.name, Eigen::Translation3d(stand.position_world) * stand.R_world_object);
          },
          [&](const DropObject& drop) {
            session.drop({drop.name, drop.position_world, drop.near_world, drop.height_m,
                          R_world_object_of(drop.turned_deg)});
          },
          [&](const ThrowObject& thrown) {
            session.place(thrown.name, {thrown.position_world, R_world_object_of(thrown.turned_deg),
                                        thrown.velocity_world_mps, thrown.angular_velocity_world_rad_s});
          },
          [&](const ChangeMaterial& change) { session.set_material(change.name, change.material); },
          [&](const RemoveObject& remove) { session.remove(remove.name); },
          [&](const TurnObject& turn) { session.turn(turn.name, turn.turn_world_deg); },
          [&](const CarryObject& carry) { session.carry(carry.name, carry.position_world); },
          [&](const ReleaseObject& release) { session.release(release.name, release.velocity_world_mps); },
          [&](const SetSurfaces& set) { session.set_surfaces(set.surfaces); },
          [&](const SetUnknown& set) { set_unknown(session, set); },
          [&](const SetRadar& set) { session.set_radar(set.radar); },
          [&](const SetQuality& set) { session.set_quality_from(set.from, set.quality); },
          [&](const CommitChanges&) { session.commit_changes(); },
          [](const PlayCamera&) {},
          [](const Quit&) {},
      },
      event.action);
}

}  // namespace roomradar
