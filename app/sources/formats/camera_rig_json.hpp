// camera_rig_json.hpp: cameras as JSON, for every file that holds some.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

/// The whole file, at most 1 MiB. Throws Error naming the file.
std::string read_json_text(const std::filesystem::path& path);
/// Reads JSON whose fields "format" and "version" are these. Throws Error naming the file and what is wrong.
nlohmann::json parse_json_of_format(const std::filesystem::path& path, const char* format, int version);
/// Throws Error naming the file if it cannot be written.
void write_json(const nlohmann::json& root, const std::filesystem::path& path);

/// A field that must be there. Throws Error naming `where`, a file or a part of one, and the field.
const nlohmann::json& json_field(const nlohmann::json& object, const char* name, const std::string& where);
/// The same, a number.
double json_number(const nlohmann::json& object, const char* name, const std::string& where);

/// Whether the frames that such a file is about were freed of lens and depth errors before they were
/// recorded: its field "calibrated", false where it is left out. Throws Error as json_field.
template <typename Json>
bool said_calibrated(const Json& root, const std::string& where) {
  const auto said = root.find("calibrated");
  if (said == root.end()) return false;
  if (!said->is_boolean()) throw Error(where + ": calibrated is not true or false");
  return said->template get<bool>();
}

/// The fields depth, colour and T_colour_depth of camera.json. Throws Error as read_camera_file.
CameraRig rig_from_json(const nlohmann::json& root, const std::string& where);
nlohmann::json json_of(const CameraRig& rig);

}  // namespace roomradar
