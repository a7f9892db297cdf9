// camera_rig_json.hpp: cameras as JSON, for every file that holds some.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/sources/camera_rig.hpp"

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

/// The fields depth, colour and T_colour_depth of camera.json. Throws Error as read_camera_file.
CameraRig rig_from_json(const nlohmann::json& root, const std::string& where);
nlohmann::json json_of(const CameraRig& rig);

}  // namespace roomradar
