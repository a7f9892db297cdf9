// camera_rig_json.hpp: reads and writes the JSON that all files with cameras share.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Reads the whole file, at most 1 MiB. Throws Error naming the file if that fails.
std::string read_json_text(const std::filesystem::path& path);
/// Parses a JSON file and checks its fields "format" and "version" against the arguments. Throws Error naming
/// the file and the problem.
nlohmann::json parse_json_of_format(const std::filesystem::path& path, const char* format, int version);
/// Writes a JSON file. Throws Error naming the file if it cannot be written.
void write_json(const nlohmann::json& root, const std::filesystem::path& path);

/// Returns a required field. Throws Error if it is missing.
/// @param where  name of the file, or of the part of it that contains the object, for the message
const nlohmann::json& json_field(const nlohmann::json& object, const char* name, const std::string& where);
/// Returns a required number. Throws Error if the field is missing or not a number.
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

/// Reads the fields depth, colour and T_colour_depth of camera.json. Throws Error, naming the field, if a
/// field is missing, of the wrong type or impossible.
CameraRig rig_from_json(const nlohmann::json& root, const std::string& where);
/// Returns the fields depth, colour and T_colour_depth of camera.json.
nlohmann::json json_of(const CameraRig& rig);

}  // namespace roomradar
