// replay.hpp: one scenario under all policies, as a video.
#pragma once
#include "app/evaluation/fallthrough/trial.hpp"
#include "app/media/video_writer.hpp"

namespace roomradar {

/// The camera's view, and for each policy the section with what the object can touch and where it goes, in
/// slow motion. Closes the video. Throws Error as VideoWriter does.
/// @param video  of kReplayPicturesPerS, with nothing in it
void write_replay(PreparedScenario& prepared, MappedRoom& room, CyberRadar& radar, VideoWriter& video);
inline constexpr double kReplayPicturesPerS = 30.0;

}  // namespace roomradar
