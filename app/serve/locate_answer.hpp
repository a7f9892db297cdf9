// locate_answer.hpp: locates a frame in one or several maps, and returns the result as JSON.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/serve/geo_pose.hpp"
#include "app/serve/served_map.hpp"
#include "mapping/localization/recognise_place.hpp"

namespace roomradar {

/// A map that is searched.
struct SearchedMap {
  std::string name;
  std::shared_ptr<const MapSnapshot> snapshot;
};

/// Locates the frame in all maps. The result for a found frame is
///
///     {"found": true, "map": NAME, "pose": {"position_m": [x, y, z], "quaternion_xyzw": [x, y, z, w]},
///      "feature_inliers": N, "rival_inliers": N, "depth_agreement": 0..1, "overlap": 0..1,
///      "tiles": [{"name": ..., "glb": ..., "distance_m": ...}], "geopose": {...} or "local"}
///
/// with the depth camera's pose in the map's world frame (camera: x right, y down, z forward), and the tiles
/// within 5 m, nearest first. Otherwise, the result is
///
///     {"found": false, "reason": "ambiguous", "sentence": "..."}
///
/// The result is also ambiguous if the frame is found or ambiguous in a second map with at least half as many
/// inliers as the best map. Throws Error if a map's keyframes are missing or damaged.
nlohmann::json locate_in(std::span<const SearchedMap> maps, const Frame& frame,
                         const std::optional<GeoAnchor>& anchor);

}  // namespace roomradar
