// odometry_checkpoint.hpp: saves an odometry to disk and restores it.
#pragma once
#include <filesystem>

#include "mapping/odometry/odometry.hpp"

namespace roomradar {

/// Writes the state of an odometry into the empty folder `into`; call odometry.finish_jobs() first. Files:
/// state.bin, and per keyframe its view (keyframe-NUMBER-REVISION.bin) and its database entry
/// (place-NUMBER.bin). The database of a prior map is not written. Throws Error if a file cannot be written.
/// @param previous  folder of an earlier checkpoint of the same odometry, or empty; files that exist there
///                  under the same name are linked, or copied if linking fails
void save_odometry(const Odometry& odometry, const std::filesystem::path& into,
                   const std::filesystem::path& previous);

/// Restores a saved odometry; tracking continues with the frame after the last saved one. `config` must equal
/// the saved odometry's. Call set_prior_map() again if it was used. Throws Error (naming the file and the
/// problem) if a file is missing, truncated, altered, of another version, or inconsistent with the others.
/// Sizes are checked before memory is allocated.
Odometry load_odometry(const std::filesystem::path& folder, const OdometryConfig& config);

}  // namespace roomradar
