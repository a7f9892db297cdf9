// session_events.hpp: executes events of scripts and of the user interface in a session.
#pragma once
#include <string>

#include "app/session/script/script.hpp"
#include "app/session/session.hpp"

namespace roomradar {

/// Name of the object in a run with one --object and without a script.
inline constexpr const char* kOnlyObject = "object";

/// Returns an object name derived from a mesh path: the file's name, without the folder, up to its first dot.
/// White space and `#` become underscores.
std::string object_name(const std::string& mesh);

/// Executes an event: adds, moves or removes an object, or changes a policy. Call it before the frame in
/// which the event is due. Ignores PlayCamera and Quit, which callers handle. Throws Error, and changes
/// nothing, for an unknown object, a taken name, an unreadable mesh or incompatible policies. Also throws for
/// a size refused by require_sensible_size(), and as place() and drop() do.
void apply(Session& session, const ScriptEvent& event);

/// Executes `add` with the parts that object_parts() made of object_model(add.source).
/// @param line  ScriptEvent::line
void add_object(Session& session, const AddObject& add, int line, ObjectParts parts);

}  // namespace roomradar
