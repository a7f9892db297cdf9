// map_info_json.hpp: map.json as text.
#pragma once
#include <string>

#include "mapping/map/map_folder.hpp"

namespace roomradar {

std::string to_json(const MapInfo& info);

/// The text is not trusted. Throws Error that starts with `where` (the file's path) and names the fault: not
/// JSON, not a map, of a later format version, a field that is missing, of another type or out of its range.
MapInfo parse_map_info(const std::string& text, const std::string& where);

}  // namespace roomradar
