// odometry_checkpoint.hpp: an odometry on disk, to go on with after the program ends.
#pragma once
#include <filesystem>

#include "mapping/odometry/odometry.hpp"

namespace roomradar {

/// Writes all that a settled odometry knows into the empty folder `into`: state.bin, and for each keyframe
/// its view, keyframe-NUMBER-REVISION.bin, and its place, place-NUMBER.bin. Those that `previous`, an earlier
/// checkpoint of the same odometry or an empty path, has under the same name become links to its files (or
/// copies, where links cannot be made). Known places are not written. Throws Error if something cannot be
/// written.
void save_odometry(const Odometry& odometry, const std::filesystem::path& into,
                   const std::filesystem::path& previous);

/// The odometry again; tracking goes on with the frame after the last. `config` must be what it had, and
/// known places must be given again. Throws Error naming the file and the fault if one is missing, cut short,
/// altered, of another version, or does not fit the others; sizes are checked before memory is taken.
Odometry load_odometry(const std::filesystem::path& folder, const OdometryConfig& config);

}  // namespace roomradar
