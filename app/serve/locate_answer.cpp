// locate_answer.cpp: locates a frame in each map, and selects the best result.
#include "app/serve/locate_answer.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace roomradar {
namespace {

using nlohmann::json;

constexpr double kAround_m = 5.0;
constexpr double kRivalMapPart = 0.5;  // of the best map's inliers

const char* sentence_on(PlaceStatus status) {
  switch (status) {
    case PlaceStatus::kFound:
      return "";
    case PlaceStatus::kNoKeyframes:
      return "the map has no keyframes";
    case PlaceStatus::kNoDepth:
      return "the depth image has almost no measurement; stay 0.5 to 5 m from surfaces";
    case PlaceStatus::kNoColour:
      return "the colour image has almost no features with depth; point the camera at furniture or pictures";
    case PlaceStatus::kNoMatch:
      return "no part of the map looks like this; point the camera at a place that was scanned";
    case PlaceStatus::kNotVerified:
      return "a part of the map looks like this, but its depth is another; has the room changed?";
    case PlaceStatus::kAmbiguous:
      return "two places fit equally well; turn until something is seen that only one of them has";
  }
  return "";
}

json refusal(PlaceStatus status) {
  return {{"found", false}, {"reason", to_string(status)}, {"sentence", sentence_on(status)}};
}

json tiles_around(const MapSnapshot& map, const Eigen::Vector3d& p_world) {
  std::vector<std::pair<double, const ServedTile*>> near;
  for (const ServedTile& tile : map.tiles()) {
    const double distance_m = tile.box_world.exteriorDistance(p_world);
    if (distance_m <= kAround_m) near.emplace_back(distance_m, &tile);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  json tiles = json::array();
  for (const auto& [distance_m, tile] : near)
    tiles.push_back({{"name", tile->name}, {"glb", tile->glb}, {"distance_m", distance_m}});
  return tiles;
}

json answer_of(const SearchedMap& map, const RecognisedPlace& place, const std::optional<GeoAnchor>& anchor) {
  const Eigen::Vector3d p = place.T_world_camera.translation();
  const Eigen::Quaterniond q(place.T_world_camera.linear());
  return {
      {"found", true},
      {"map", map.name},
      {"pose", {{"position_m", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}}},
      {"feature_inliers", place.feature_inliers},
      {"rival_inliers", place.rival_inliers},
      {"depth_agreement", place.depth_agreement},
      {"overlap", place.overlap},
      {"tiles", tiles_around(*map.snapshot, p)},
      {"geopose", anchor ? json_of(geo_pose_of(*anchor, place.T_world_camera)) : json("local")}};
}

/// Order of refusals: the one that came nearest to a place is told.
int nearness(PlaceStatus status) {
  switch (status) {
    case PlaceStatus::kAmbiguous:
      return 3;
    case PlaceStatus::kNotVerified:
      return 2;
    case PlaceStatus::kNoMatch:
      return 1;
    default:
      return 0;
  }
}

}  // namespace

json locate_in(std::span<const SearchedMap> maps, const Frame& frame,
               const std::optional<GeoAnchor>& anchor) {
  std::vector<std::pair<RecognisedPlace, const SearchedMap*>> outcomes;
  for (const SearchedMap& map : maps)
    outcomes.emplace_back(recognise_place(frame, map.snapshot->keyframes()), &map);
  std::stable_sort(outcomes.begin(), outcomes.end(), [](const auto& a, const auto& b) {
    const auto rank = [](const RecognisedPlace& of) {
      return of ? 1'000'000 + of.feature_inliers : nearness(of.status);
    };
    return rank(a.first) > rank(b.first);
  });
  if (outcomes.empty()) return refusal(PlaceStatus::kNoKeyframes);
  const auto& [best, map] = outcomes.front();
  if (!best) return refusal(best.status);
  for (std::size_t i = 1; i < outcomes.size(); ++i) {
    const RecognisedPlace& other = outcomes[i].first;
    // An ambiguous one fits, too.
    const bool fits = other || other.status == PlaceStatus::kAmbiguous;
    if (fits && other.feature_inliers >= kRivalMapPart * best.feature_inliers)
      return refusal(PlaceStatus::kAmbiguous);
  }
  return answer_of(*map, best, anchor);
}

}  // namespace roomradar
