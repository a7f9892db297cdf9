// run_summary.hpp: summary that a run prints at its end.
#pragma once

namespace roomradar {

class Session;
struct OpenedRun;

/// Prints to stdout: frames per second, time per frame, the slowest stage, the number of localised frames,
/// each object and the surface that supports it, and the files written. With --verbose, also prints RunUse.
void print_summary(const OpenedRun& run);

/// Prints for each object of the session its position and the surface that supports it, or why it is not in
/// the room.
void print_objects(const Session& session);

}  // namespace roomradar
