// simulate.hpp: writes a simulated recording with its ground truth.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "app/sim/sensor/sim_options.hpp"
#include "app/sources/recordings/recording_writer.hpp"

namespace roomradar {

/// Writes the frames of a SimulatedSource into `folder` (new or empty) as a recording in `format`, and the
/// ground truth as
///   truth/depth/NNNNNN.png  exact depth, 16 bit, 1/5000 m; 0: outside the sensor's range
///   truth/moved/NNNNNN.png  8 bit; 255 if the nearest surface is a moving object
///   truth/mover/NNNNNN.png  8 bit; 0 for the room, otherwise the number of the moving object in sim.json,
///                           from 1; a crate that appears has the next number after the moving objects
///   truth/revealed/NNNNNN.png  8 bit; 255 if a crate that has disappeared would be the nearest surface
///   truth/trajectory.txt    exact poses of the depth camera, TUM format
///   truth/room.ply          surface of the room, without moving objects
///   truth/sim.json          the options, and the spec that reproduces these frames
/// moved/, mover/ and revealed/ exist only if something moves, appears or disappears.
/// @param progress  called after each frame with the number of finished frames and the total; may be empty
/// @throws Error if the options are not valid, the folder is not empty, or a file cannot be written
void simulate(const std::filesystem::path& folder, const SimOptions& options, RecordingFormat format,
              const std::function<void(std::int64_t, std::int64_t)>& progress = {});

}  // namespace roomradar
