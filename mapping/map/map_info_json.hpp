// map_info_json.hpp: converts MapInfo to and from the text of map.json.
#pragma once
#include <string>

#include "mapping/map/map_info.hpp"

namespace roomradar {

std::string to_json(const MapInfo& info);

/// Parses and validates the text of map.json. Throws Error if the text is not JSON, not a map's or of a later
/// format version. Also throws if a field is missing, of the wrong type or out of range. The message starts
/// with `where` (the file's path) and names the fault.
MapInfo parse_map_info(const std::string& text, const std::string& where);

}  // namespace roomradar
