// replay.hpp: one scenario under all policies, as a video.
#pragma once
#include <filesystem>

#include "app/fallthrough/trial.hpp"

namespace roomradar {

/// The camera's view, and for each policy the section with what the object can touch and where it goes, in
/// slow motion. Throws Error as VideoWriter does.
void write_replay(PreparedScenario& prepared, MappedRoom& room, CyberRadar& radar,
                  const std::filesystem::path& path);

}  // namespace roomradar
