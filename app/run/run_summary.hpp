// run_summary.hpp: summary that a run prints at its end.
#pragma once

namespace roomradar {

class Session;
struct OpenedRun;

/// Prints to stdout the frames per second, time per frame, slowest stage and number of localised frames.
/// Prints each object with its supporting surface, and the files written. With --verbose, also prints RunUse.
void print_summary(const OpenedRun& run);

/// Prints each object of the session with its position and supporting surface, or the reason why it is not in
/// the room.
void print_objects(const Session& session);

}  // namespace roomradar
