// map_requests.hpp: answers requests, independently of HTTP.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/serve/geo_pose.hpp"
#include "app/serve/served_map.hpp"

namespace roomradar {

struct Answer {
  int status = 200;  ///< HTTP status
  std::string content_type = "application/json";
  std::string body;                             ///< content, unless `file` is set
  std::optional<std::filesystem::path> file{};  ///< sent instead of the body
  std::uintmax_t file_bytes = 0;
  std::string etag{};  ///< entity tag without quotes; empty: none
};

/// The served maps.
struct MapCatalogue {
  std::vector<std::unique_ptr<ServedMap>> maps;
  std::optional<GeoAnchor> anchor;
};

/// Returns an answer with the body {"error": sentence}.
Answer error_answer(int status, const std::string& sentence);

/// Answers a GET:
///   /health                            {"status": "ok"}
///   /maps                              the maps
///   /maps/NAME                         facts, as `roomradar map info --json`
///   /maps/NAME/tileset.json            only for buildings
///   /maps/NAME/tiles/FILE              only for buildings
///   /maps/NAME/mesh.ply, texture.jpg   only for rooms
/// Does not throw. Thread safe.
/// @param path           decoded, without the query
/// @param if_none_match  the request's field; the status is 304 if it contains the content's tag
Answer answer_get(const MapCatalogue& catalogue, std::string_view path, std::string_view if_none_match);

/// Returns true for the paths that answer_locate() answers: /locate, /maps/NAME/locate.
bool is_locate_path(std::string_view path);
/// Answers a POST to such a path. Does not throw. Thread safe.
/// @param body  see parse_locate_request()
Answer answer_locate(const MapCatalogue& catalogue, std::string_view path, std::string_view body);

}  // namespace roomradar
