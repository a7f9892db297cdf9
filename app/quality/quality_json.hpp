// quality_json.hpp: converts quality settings to JSON, and validated JSON to quality settings.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "app/quality/quality.hpp"

namespace roomradar {

/// Returns all fields as name-value pairs.
nlohmann::ordered_json to_json(const ScanQuality& quality);
nlohmann::ordered_json to_json(const RunQuality& quality);

/// Parse quality settings. Missing fields have their defaults. Former names of fields are accepted. Throw
/// Error "WHERE: ..." if `json` is not an object, a name is unknown, or a value has the wrong type or is out
/// of range.
ScanQuality scan_quality_of(const nlohmann::ordered_json& json, const std::string& where);
RunQuality run_quality_of(const nlohmann::ordered_json& json, const std::string& where);

}  // namespace roomradar
