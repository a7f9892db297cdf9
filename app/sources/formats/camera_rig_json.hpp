// camera_rig_json.hpp: reads and writes the JSON fields that all files with cameras have in common.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Reads the whole file, at most 1 MiB. Throws Error with the file's name if it cannot be read or is larger.
std::string read_json_text(const std::filesystem::path& path);
/// Parses a JSON file. Throws Error naming the file and the fault if it is not JSON, or its fields "format"
/// and "version" differ from the arguments.
nlohmann::json parse_json_of_format(const std::filesystem::path& path, const char* format, int version);
/// Writes a JSON file. Throws Error with the file's name if it cannot be written.
void write_json(const nlohmann::json& root, const std::filesystem::path& path);

/// Returns the field `name`. Throws Error if it is missing.
/// @param where  for the error message: name of the file, or of the part of the file that contains `object`
const nlohmann::json& json_field(const nlohmann::json& object, const char* name, const std::string& where);
/// Returns the number in field `name`. Throws Error if the field is missing or not a number.
double json_number(const nlohmann::json& object, const char* name, const std::string& where);

/// Returns the field "calibrated": true if lens and depth errors were removed from the frames before
/// recording, false if it is absent. Throws Error if it is not a boolean.
template <typename Json>
bool said_calibrated(const Json& root, const std::string& where) {
  const auto said = root.find("calibrated");
  if (said == root.end()) return false;
  if (!said->is_boolean()) throw Error(where + ": calibrated is not true or false");
  return said->template get<bool>();
}

/// Reads the fields depth, colour, T_colour_depth, timing and depth_noise of camera.json. Throws Error naming
/// a field that is missing, has the wrong type or an invalid value.
CameraRig rig_from_json(const nlohmann::json& root, const std::string& where);
/// Returns the fields depth, colour, T_colour_depth, timing and depth_noise of camera.json.
nlohmann::json json_of(const CameraRig& rig);

}  // namespace roomradar
