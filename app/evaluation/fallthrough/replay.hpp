// replay.hpp: shows one scenario under all policies as a video.
#pragma once
#include "app/evaluation/fallthrough/trial.hpp"
#include "app/media/video_writer.hpp"

namespace roomradar {

/// Writes and closes a video in slow motion: the camera's view and, per policy, a section with the surfaces
/// and the object's path. Throws Error as VideoWriter does.
/// @param video  without pictures so far; its rate is kReplayPicturesPerS
void write_replay(PreparedScenario& prepared, MappedRoom& room, CyberRadar& radar, VideoWriter& video);
inline constexpr double kReplayPicturesPerS = 30.0;

}  // namespace roomradar
