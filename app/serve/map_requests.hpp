// map_requests.hpp: the answers to requests, apart from HTTP.
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
  int status = 200;  ///< of HTTP
  std::string content_type = "application/json";
  std::string body;                             ///< if there is no file
  std::optional<std::filesystem::path> file{};  ///< is sent in place of a body
  std::uintmax_t file_bytes = 0;
  std::string etag{};  ///< without quotes; empty: none
};

/// The maps that are served.
struct MapCatalogue {
  std::vector<std::unique_ptr<ServedMap>> maps;
  std::optional<GeoAnchor> anchor;
};

/// Returns an answer with {"error": sentence}.
Answer error_answer(int status, const std::string& sentence);

/// Answers a GET:
///   /health                            {"status": "ok"}
///   /maps                              list of the maps
///   /maps/NAME                         facts, as `roomradar map info --json`
///   /maps/NAME/tileset.json            of a building
///   /maps/NAME/tiles/FILE              of a building
///   /maps/NAME/mesh.ply, texture.jpg   of a room
/// Does not throw. Thread safe.
/// @param path           decoded, without the query
/// @param if_none_match  the field of the request; the answer's status is 304 if it has the content's tag
Answer answer_get(const MapCatalogue& catalogue, std::string_view path, std::string_view if_none_match);

/// Returns true for the paths that answer_locate() answers: /locate, /maps/NAME/locate.
bool is_locate_path(std::string_view path);
/// Answers a POST to such a path. Does not throw. Thread safe.
/// @param body  see parse_locate_request()
Answer answer_locate(const MapCatalogue& catalogue, std::string_view path, std::string_view body);

}  // namespace roomradar
