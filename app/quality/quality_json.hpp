// quality_json.hpp: qualities to and from JSON, which is not trusted.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "app/quality/quality.hpp"

namespace roomradar {

/// Every field by its name.
nlohmann::ordered_json to_json(const ScanQuality& quality);
nlohmann::ordered_json to_json(const RunQuality& quality);

/// What is not named is the default's. Throws Error "WHERE: ..." for what is not an object, a name that is
/// none, a value that is of the wrong kind or out of its rule.
ScanQuality scan_quality_of(const nlohmann::ordered_json& json, const std::string& where);
RunQuality run_quality_of(const nlohmann::ordered_json& json, const std::string& where);

}  // namespace roomradar
