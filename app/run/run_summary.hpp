// run_summary.hpp: what a run says at its end.
#pragma once

namespace roomradar {

class Session;
struct OpenedRun;

/// Prints to stdout: frames per second, time per frame and the stage that takes most of it, frames in which
/// the camera was located, each object and what it rests on, and the files written. With --verbose also how
/// much of the room and of the depth the frames needed.
void print_summary(const OpenedRun& run);

/// Prints each object of the session: where it is, what it rests on, or why it is not in the room.
void print_objects(const Session& session);

}  // namespace roomradar
