// session_events.cpp: one typed call of Session per kind of event.
#include "app/session/script/session_events.hpp"

#include "mapping/types/system/stage_times.hpp"

namespace roomradar {
namespace {

ObjectState state_of(const ScriptEvent& event) {
  return {*event.position_world, event.R_world_object, event.velocity_world_mps,
          event.angular_velocity_world_rad_s};
}

}  // namespace

void apply(Session& session, const ScriptEvent& event) {
  switch (event.action) {
    case Action::kAdd:
      session.add_object(event.name, object_mesh(event.mesh, event.size_m.value_or(0.0)));
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
