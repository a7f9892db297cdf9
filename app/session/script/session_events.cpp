// session_events.cpp: one typed call of Session per kind of event.
#include "app/session/script/session_events.hpp"

#include <cctype>
#include <string>
#include <utility>

#include "mapping/types/system/stage_times.hpp"

namespace roomradar {
namespace {

ObjectState state_of(const ScriptEvent& event) {
  return {*event.position_world, event.R_world_object, event.velocity_world_mps,
          event.angular_velocity_world_rad_s};
}

/// Returns the text that a user's script or command line needs before a size.
std::string option_before_size(const ScriptEvent& add) {
  if (add.line > 0) return "add " + add.name + " " + add.mesh + " size ";
  return add.name == kOnlyObject ? "--object-size " : "--object " + add.mesh + ",size=";
}

void require_sensible_size(const Session& session, const ScriptEvent& add, const Model& model) {
  require_sensible_size(model, source_of(add), {session.room_extent_m(), option_before_size(add)});
}

void add_object(Session& session, const ScriptEvent& add) {
  Model model = object_model(source_of(add));
  require_sensible_size(session, add, model);
  session.add_object(add.name, std::move(model), add.material);
}

}  // namespace

void add_object(Session& session, const ScriptEvent& add, ObjectParts parts) {
  require_sensible_size(session, add, parts.source);
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
  switch (event.action) {
    case Action::kAdd:
      add_object(session, event);
      break;
    case Action::kPlace:
    case Action::kThrow:
      session.place(event.name, state_of(event));
      break;
    case Action::kDrop:
      session.drop(
          {event.name, event.position_world, event.near_world, event.height_m, event.R_world_object});
      break;
    case Action::kCarry:
      session.carry(event.name, *event.position_world);
      break;
    case Action::kRelease:
      session.release(event.name, event.velocity_world_mps);
      break;
    case Action::kTurn:
      session.turn(event.name, event.turn_world_deg);
      break;
    case Action::kMaterial:
      session.set_material(event.name, event.material);
      break;
    case Action::kRemove:
      session.remove(event.name);
      break;
    case Action::kSurfaces:
      session.set_surfaces(event.surfaces);
      break;
    case Action::kUnknown: {
      StageTimes unreported;
      if (event.unknown_is_solid)
        session.make_unknown_solid(unreported);
      else
        session.make_unknown_free();
      break;
    }
    case Action::kRadar:
      session.set_radar(event.radar);
      break;
    case Action::kQuality:
      session.set_quality_from(event.from, event.quality);
      break;
    case Action::kCommit:
      session.commit_changes();
      break;
    case Action::kCamera:
    case Action::kQuit:
      break;
  }
}

}  // namespace roomradar
