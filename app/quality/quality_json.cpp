// quality_json.cpp: one key per field.
#include "app/quality/quality_json.hpp"

#include <string_view>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Json = nlohmann::ordered_json;

template <typename Value>
Json json_of(const Value& value) {
  if constexpr (std::is_same_v<Value, RadarMode>)
    return to_string(value);
  else
    return value;
}

template <typename Quality>
Json json_of_fields(const Quality& quality) {
  Json json;
  visit_fields(quality,
               [&](const QualityField& field, const auto& value) { json[field.name] = json_of(value); });
  return json;
}

/// Returns the value as a word for set_field().
std::string word_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename Quality>
Quality quality_of(const Json& json, const std::string& where) {
  if (!json.is_object()) throw Error(where + ": is not a JSON object of settings");
  Quality quality;
  for (const auto& [name, value] : json.items()) {
    if (value.is_structured()) throw Error(where + ": " + name + ": is not a single value");
    try {
      set_field(quality, name, word_of(value));
    } catch (const Error& fault) {
      throw Error(where + ": " + fault.what());
    }
  }
  return quality;
}

}  // namespace

Json to_json(const ScanQuality& quality) { return json_of_fields(quality); }
Json to_json(const RunQuality& quality) { return json_of_fields(quality); }

ScanQuality scan_quality_of(const Json& json, const std::string& where) {
  return quality_of<ScanQuality>(json, where);
}
RunQuality run_quality_of(const Json& json, const std::string& where) {
  return quality_of<RunQuality>(json, where);
}

}  // namespace roomradar
