// odometry_checkpoint.hpp: saves an odometry to disk and restores it.
#pragma once
#include <filesystem>

#include "mapping/odometry/odometry.hpp"

namespace roomradar {

/// Writes the state of a settled odometry into the empty folder `into`: state.bin, and per keyframe its view,
/// keyframe-NUMBER-REVISION.bin, and its database entry, place-NUMBER.bin. `previous` is an earlier
/// checkpoint of the same odometry, or empty; its files of the same name are linked, or copied if linking
/// fails. The known map is not written. Throws Error if a file cannot be written.
void save_odometry(const Odometry& odometry, const std::filesystem::path& into,
                   const std::filesystem::path& previous);

/// Restores a saved odometry; tracking continues with the frame after the last. `config` must be the saved
/// odometry's, and the known map must be set again. Throws Error naming the file and the fault if a file is
/// missing, truncated, altered, of another version, or inconsistent with the others. Sizes are checked before
/// memory is allocated.
Odometry load_odometry(const std::filesystem::path& folder, const OdometryConfig& config);

}  // namespace roomradar
