// simulate.hpp: writes a simulated recording with its ground truth beside it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "app/sim/sensor/sim_options.hpp"
#include "app/sources/recordings/recording_writer.hpp"

namespace roomradar {

/// Writes the frames of `options` into `folder` (new or empty) as a recording of `format`, and beside them
///   truth/depth/NNNNNN.png  exact depth, 16 bit, 1/5000 m, 0 = outside of the sensor's range
///   truth/moved/NNNNNN.png  8 bit; 255 where the nearest surface is a moving thing
///   truth/mover/NNNNNN.png  8 bit; 0 = the room, else the number of the mover in sim.json, from 1; past them
///                           the crate that came
///   truth/revealed/NNNNNN.png  8 bit; 255 where a crate that went would be the nearest surface
///   truth/trajectory.txt    exact depth-camera poses, TUM form
///   truth/room.ply          the room's surface, without what moves
///   truth/sim.json          the options, and the spec that makes the same frames again
/// moved/, mover/ and revealed/ are there only if something moves, comes or goes.
/// @param progress  called after each frame with frames done and frames in all; may be empty
/// Throws Error if the options are not valid, the folder holds anything, or a file cannot be written.
void simulate(const std::filesystem::path& folder, const SimOptions& options, RecordingFormat format,
              const std::function<void(std::int64_t, std::int64_t)>& progress = {});

}  // namespace roomradar
