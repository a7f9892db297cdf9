// script_event.cpp: tells which actions name an object, and when an event is due.
#include "app/session/script/script_event.hpp"

namespace roomradar {

ObjectSource source_of(const ScriptEvent& add) { return {add.mesh, add.size_m, add.up, add.origin}; }

bool has_object(Action action) {
  switch (action) {
    case Action::kSurfaces:
    case Action::kUnknown:
    case Action::kRadar:
    case Action::kQuality:
    case Action::kCamera:
    case Action::kCommit:
    case Action::kQuit:
      return false;
    default:
      return true;
  }
}

bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s) {
  return event.frame ? *event.frame <= run_frame : event.time_s && *event.time_s <= run_time_s;
}

}  // namespace roomradar
