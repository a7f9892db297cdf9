// replay.hpp: shows one scenario with all policies as a video.
#pragma once
#include "app/evaluation/fallthrough/trial.hpp"
#include "app/media/video_writer.hpp"

namespace roomradar {

/// Writes a slow-motion video and closes it. The video shows the camera's view and, per policy, a section
/// with the surfaces and the object's path. Throws Error as VideoWriter does.
/// @param video  must contain no pictures yet and have the rate kReplayPicturesPerS
void write_replay(PreparedScenario& prepared, MappedRoom& room, Radar& radar, VideoWriter& video);
inline constexpr double kReplayPicturesPerS = 30.0;

}  // namespace roomradar
