// map_requests.cpp: maps request paths to answers.
#include "app/serve/map_requests.hpp"

#include <algorithm>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/building/tileset.hpp"
#include "app/serve/geo_pose.hpp"
#include "app/serve/locate_request.hpp"
#include "app/serve/served_map.hpp"
#include "mapping/localization/recognise_place.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// A map that is searched.
struct SearchedMap {
  std::string name;
  std::shared_ptr<const MapSnapshot> snapshot;
};

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

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kMapsPath = "/maps", kLocate = "locate";

/// JSON may quote what a client sent, which need not be UTF-8.
std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

/// Sets 304 and drops the content if the client has it.
Answer unless_known(Answer answer, std::string_view if_none_match) {
  const bool is_known =
      !answer.etag.empty() &&
      (if_none_match == "*" || if_none_match.find("\"" + answer.etag + "\"") != std::string_view::npos);
  if (!is_known) return answer;
  answer.status = 304;
  answer.body.clear();
  answer.file.reset();
  return answer;
}

Answer json_answer(std::string text) {
  Answer answer;
  answer.etag = sha256_of(text);
  answer.body = std::move(text);
  return answer;
}

const char* content_type_of(const fs::path& name) {
  if (name.extension() == ".glb") return "model/gltf-binary";
  if (name.extension() == ".jpg") return "image/jpeg";
  return "application/octet-stream";
}

Answer file_answer(const MapSnapshot& map, const ContentFile& file) {
  Answer answer;
  answer.content_type = content_type_of(file.name);
  answer.file = map.folder() / file.name;
  answer.file_bytes = file.bytes;
  answer.etag = file.sha256;
  std::error_code fault;
  if (!fs::is_regular_file(*answer.file, fault) || fs::file_size(*answer.file, fault) != file.bytes)
    return error_answer(503, "the file was replaced or is damaged; ask for the map's facts again");
  return answer;
}

ServedMap* map_named(const MapCatalogue& catalogue, std::string_view name) {
  const auto found = std::find_if(catalogue.maps.begin(), catalogue.maps.end(),
                                  [&](const auto& map) { return map->name() == name; });
  return found == catalogue.maps.end() ? nullptr : found->get();
}

/// Splits "/maps/NAME/REST" at the name. Returns false for other paths.
bool split(std::string_view path, std::string_view& name, std::string_view& rest) {
  if (!path.starts_with("/maps/")) return false;
  path.remove_prefix(kMapsPath.size() + 1);
  const std::size_t slash = path.find('/');
  name = path.substr(0, slash);
  rest = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  return true;
}

Answer list_of(const MapCatalogue& catalogue) {
  json maps = json::array();
  for (const auto& map : catalogue.maps)
    maps.push_back(
        {{"name", map->name()}, {"kind", map->current()->kind()}, {"url", "/maps/" + map->name()}});
  return json_answer(text_of({{"maps", maps}}));
}

Answer found_at(const MapCatalogue& catalogue, std::string_view path) {
  if (path == "/health") return {.body = text_of({{"status", "ok"}})};
  if (path == kMapsPath || path == "/maps/") return list_of(catalogue);
  std::string_view name, rest;
  if (!split(path, name, rest)) return error_answer(404, "there is nothing; /maps lists the maps");
  ServedMap* map = map_named(catalogue, name);
  if (map == nullptr) return error_answer(404, "there is no such map; /maps lists the maps");
  const std::shared_ptr<const MapSnapshot> snapshot = map->current();
  if (rest.empty()) return json_answer(snapshot->info_text());
  if (rest == kLocate) return error_answer(405, "send a frame with POST");
  if (rest == kTilesetFile && !snapshot->tileset_text().empty()) return json_answer(snapshot->tileset_text());
  const auto file = snapshot->files().find(std::string(rest));
  if (file == snapshot->files().end())
    return error_answer(404, "the map has no such file; /maps/" + map->name() + " lists its files");
  return file_answer(*snapshot, file->second);
}

Answer located(const MapCatalogue& catalogue, std::string_view path, std::string_view body) {
  std::vector<SearchedMap> searched;
  std::string_view name, rest;
  if (split(path, name, rest)) {
    ServedMap* map = map_named(catalogue, name);
    if (map == nullptr) return error_answer(404, "there is no such map; /maps lists the maps");
    searched.push_back({map->name(), map->current()});
  } else {
    for (const auto& map : catalogue.maps) searched.push_back({map->name(), map->current()});
  }
  Frame frame;
  try {
    frame = parse_locate_request(body);
  } catch (const Error& fault) {
    return error_answer(400, fault.what());
  }
  return {.body = text_of(locate_in(searched, frame, catalogue.anchor))};
}

/// Turns exceptions into answers.
template <typename Work>
Answer answered(const Work& work) {
  try {
    return work();
  } catch (const Error& fault) {
    return error_answer(503, fault.what());
  } catch (const std::bad_alloc&) {
    return error_answer(503, "memory ran out; try again later");
  } catch (const std::exception& fault) {
    return error_answer(500, fault.what());
  }
}

}  // namespace

Answer error_answer(int status, const std::string& sentence) {
  Answer answer;
  answer.status = status;
  answer.body = text_of({{"error", sentence}});
  return answer;
}

Answer answer_get(const MapCatalogue& catalogue, std::string_view path, std::string_view if_none_match) {
  return answered([&] { return unless_known(found_at(catalogue, path), if_none_match); });
}

bool is_locate_path(std::string_view path) {
  std::string_view name, rest;
  return path == "/locate" || (split(path, name, rest) && rest == kLocate);
}

Answer answer_locate(const MapCatalogue& catalogue, std::string_view path, std::string_view body) {
  return answered([&] { return located(catalogue, path, body); });
}

}  // namespace roomradar
