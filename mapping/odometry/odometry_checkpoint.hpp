// odometry_checkpoint.hpp: saves the state of an Odometry object to disk and restores it.
#pragma once
#include <filesystem>

#include "mapping/odometry/odometry.hpp"

namespace roomradar {

/// Writes the state of an Odometry object into the empty folder `into`. Call odometry.finish_jobs() first.
/// Writes state.bin, and per keyframe its images (StoredView, keyframe-NUMBER-REVISION.bin) and its entry for
/// place recognition (place-NUMBER.bin). Does not write the database of a prior map. Throws Error if a file
/// cannot be written.
/// @param previous  folder of an earlier checkpoint of the same object, or empty. A file that exists
///                  there by the same name is hard-linked into `into`, or copied if linking fails
void save_odometry(const Odometry& odometry, const std::filesystem::path& into,
                   const std::filesystem::path& previous);

/// Restores a saved Odometry object. Tracking continues with the frame after the last saved one. `config`
/// must equal the saved object's. Call set_prior_map() again if it was used. Throws Error naming the file and
/// the fault if a file is missing, truncated, altered, of another version, or inconsistent with the others.
/// Sizes are checked before memory is allocated.
Odometry load_odometry(const std::filesystem::path& folder, const OdometryConfig& config);

}  // namespace roomradar
