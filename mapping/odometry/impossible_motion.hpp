// impossible_motion.hpp: poses between which the camera would have moved as no camera moves.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/odometry/odometry_config.hpp"

namespace roomradar {

/// Removes the trust in poses (TrackedFrame::trusted) at which the camera would have been accelerated by more
/// than 30 m/s^2, and in those between two of these less than 0.2 s apart. Where depth constrains a direction
/// by noise alone, as in a bare hall, poses jump by decimetres along it. A hand accelerates a camera by up to
/// 16 m/s^2, measured in recordings of rooms. Deviations of less than 30 mm count as noise of the poses.
/// Untrusted poses and other parts are passed over.
/// @return number of poses that lost their trust
std::int64_t distrust_impossible_motion(std::vector<TrackedFrame>& frames);

}  // namespace roomradar
