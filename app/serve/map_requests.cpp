// map_requests.cpp: maps request paths to answers.
#include "app/serve/map_requests.hpp"

#include <algorithm>
#include <new>
#include <nlohmann/json.hpp>

#include "app/building/tileset.hpp"
#include "app/serve/locate_answer.hpp"
#include "app/serve/locate_request.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

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
