// scan_parts.hpp: joins the parts of a scan that tracking has left unconnected.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/odometry_config.hpp"

namespace roomradar {

/// Stretch of a scan between two losses of tracking.
struct ScanPart {
  std::int64_t first = 0, last = 0;  ///< frame indices, both included
  std::int64_t frames = 0;           ///< number of frames with a trusted pose within the part
  bool is_joined = false;            ///< true: its frames are in the map
};

/// Joins the parts that show the same place, as recordings of a building are joined (join_submaps()), and
/// keeps the connected parts with the most frames. Their poses are then in the world frame of the longest of
/// them. Frames of the other parts lose their trusted pose, and their keyframes are removed. With a single
/// part, nothing changes.
/// @param[in,out] frames             all frames, in order
/// @param[in,out] keyframe_database  of all parts
/// @param is_in_known_map            poses are in the world of an earlier map: the first part, and what joins
///                                   it, is kept
/// @param[out] main_part             number of the part whose world frame is kept (TrackedFrame::part)
/// @return parts with at least 10 frames, in order of time
std::vector<ScanPart> join_parts(std::vector<TrackedFrame>& frames, KeyframeDatabase& keyframe_database,
                                 bool is_in_known_map, int& main_part);

}  // namespace roomradar
