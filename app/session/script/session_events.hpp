// session_events.hpp: executes the events of scripts and users in a session.
#pragma once
#include <string>

#include "app/session/script/script.hpp"
#include "app/session/session.hpp"

namespace roomradar {

/// Name of the object of a run without a script and with one --object.
inline constexpr const char* kOnlyObject = "object";

/// Returns a name for an object of this mesh: the file's name without folder and extension, as one word.
std::string object_name(const std::string& mesh);

/// Executes an event before the frame in which it is due: adds, moves or removes an object, or changes a
/// policy. kCamera and kQuit are for the caller and do nothing here. Throws Error and changes nothing if the
/// event is impossible: unknown object, name taken, unreadable mesh, absurd size, incompatible policies.
void apply(Session& session, const ScriptEvent& event);

}  // namespace roomradar
