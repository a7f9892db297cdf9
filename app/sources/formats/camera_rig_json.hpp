// camera_rig_json.hpp: JSON reading and writing shared by all files that contain cameras.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Reads the whole file, max 1 MiB. Throws Error naming the file.
std::string read_json_text(const std::filesystem::path& path);
/// Parses a JSON file and checks its fields "format" and "version" against the arguments. Throws Error naming
/// the file and the fault.
nlohmann::json parse_json_of_format(const std::filesystem::path& path, const char* format, int version);
/// Throws Error naming the file if it cannot be written.
void write_json(const nlohmann::json& root, const std::filesystem::path& path);

/// Returns a required field. Throws Error naming the field and `where`, a file or a part of one.
const nlohmann::json& json_field(const nlohmann::json& object, const char* name, const std::string& where);
/// Same as json_field(), for a number.
double json_number(const nlohmann::json& object, const char* name, const std::string& where);

/// Returns the field "calibrated": true if lens and depth errors were removed from the frames before
/// recording. Returns false if it is absent. Throws Error as json_field() does if it is not a boolean.
template <typename Json>
bool said_calibrated(const Json& root, const std::string& where) {
  const auto said = root.find("calibrated");
  if (said == root.end()) return false;
  if (!said->is_boolean()) throw Error(where + ": calibrated is not true or false");
  return said->template get<bool>();
}

/// Reads the fields depth, colour and T_colour_depth of camera.json. Throws Error as read_camera_file() does.
CameraRig rig_from_json(const nlohmann::json& root, const std::string& where);
nlohmann::json json_of(const CameraRig& rig);

}  // namespace roomradar
