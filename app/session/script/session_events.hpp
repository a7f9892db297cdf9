// session_events.hpp: executes the events of scripts and users in a session.
#pragma once
#include "app/session/script/script.hpp"
#include "app/session/session.hpp"

namespace roomradar {

/// Executes an event before the frame in which it is due: adds, moves or removes an object, or changes a
/// policy. kCamera and kQuit are for the caller and do nothing here. Throws Error and changes nothing if the
/// event is impossible: unknown object, name taken, unreadable mesh, incompatible policies.
void apply(Session& session, const ScriptEvent& event);

}  // namespace roomradar
