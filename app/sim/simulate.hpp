// simulate.hpp: writes a simulated recording with its ground truth.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "app/sim/sensor/sim_options.hpp"
#include "app/sources/recordings/recording_writer.hpp"

namespace roomradar {

/// Writes the frames of a SimulatedSource into `folder` (new or empty) as a recording in `format`, and the
/// ground truth as
///   truth/depth/NNNNNN.png  exact depth, 16 bit, 1/5000 m; 0: outside the sensor's range
///   truth/moved/NNNNNN.png  8 bit; 255 if the nearest surface is a moving object
///   truth/mover/NNNNNN.png  8 bit; 0 for the room, otherwise the 1-based number of the moving object in
///                           sim.json; a crate that appears has the next number after the moving objects
///   truth/revealed/NNNNNN.png  8 bit; 255 if a crate that has disappeared would be the nearest surface
///   truth/trajectory.txt    exact poses of the depth camera, TUM format
///   truth/room.ply          surface of the room, without moving objects. For a building: complete surfaces
///                           of all rooms, corridors and stairs that are visible from the walk
///   truth/sim.json          the options, and the spec that reproduces these frames. For a building, also the
///                           plan (floor, box and look-alike of each room) and the rooms that the walk visits
/// moved/, mover/ and revealed/ exist only if something moves, appears or disappears.
/// @param progress  called after each frame with the number of finished frames and the total; may be empty
/// @throws Error if the options are not valid, the folder is not empty, or a file cannot be written
void simulate(const std::filesystem::path& folder, const SimOptions& options, RecordingFormat format,
              const std::function<void(std::int64_t, std::int64_t)>& progress = {});

/// Writes walks `first` to `last` of a building, both included, as recordings with their truth, each as
/// simulate() does, into subfolders walk-0000, walk-0001 and so on of `folder` (new or empty). Writes the
/// list of the recordings last: recordings.txt, with a line `NAME: PATH` per recording. Paths are relative to
/// the list.
/// @param progress  called after each frame with the subfolder's name, the number of finished frames of this
///                  recording and their total; may be empty
/// @throws Error as simulate(), or if the room is not the building, or a walk is out of range
void simulate_walks(const std::filesystem::path& folder, const SimOptions& options, std::int64_t first,
                    std::int64_t last, RecordingFormat format,
                    const std::function<void(const std::string&, std::int64_t, std::int64_t)>& progress = {});

}  // namespace roomradar
