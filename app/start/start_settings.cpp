// start_settings.cpp: the settings as JSON.
#include "app/start/start_settings.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFile_bytes = 1U << 16U;
constexpr std::size_t kMaxPath_bytes = 4096;
constexpr double kMinScale = 0.5, kMaxScale = 4.0;  // as of --ui-scale

std::string path_in(const nlohmann::json& json, const char* key) {
  if (!json.contains(key)) return {};
  if (!json[key].is_string()) throw Error(std::string(key) + " must be a text");
  std::string path = json[key];
  if (path.size() > kMaxPath_bytes || path.find('\0') != std::string::npos)
    throw Error(std::string(key) + " is not a valid file name");
  return path;
}

StartSettings parse_settings(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) throw Error("it is not a JSON object");
  StartSettings settings;
  settings.last_map = path_in(json, "last_map");
  settings.last_source = path_in(json, "last_source");
  if (json.contains("ui_scale")) {
    if (!json["ui_scale"].is_number()) throw Error("ui_scale must be a number");
    const double scale = json["ui_scale"];
    if (!(scale >= kMinScale && scale <= kMaxScale)) throw Error("ui_scale must be in 0.5..4");
    settings.ui_scale = scale;
  }
  return settings;
}

}  // namespace

fs::path start_settings_file() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && fs::path(config).is_absolute())  // others are to be ignored, says its standard
    return fs::path(config) / "roomradar/start.json";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return fs::path(home) / ".config/roomradar/start.json";
}

ReadSettings read_start_settings(const fs::path& file) {
  std::error_code ignored;
  if (file.empty() || !fs::exists(file, ignored)) return {};
  try {
    return {parse_settings(read_bytes(file, "a settings file", kMaxFile_bytes)), {}};
  } catch (const std::exception& error) {  // also those of the JSON library
    const std::string what = error.what();
    const std::string name = file.string() + ": ";
    return {{}, (what.starts_with(file.string()) ? what : name + what) + "; the default settings are used"};
  }
}

void write_start_settings(const StartSettings& settings, const fs::path& file) {
  if (file.empty()) throw Error("the settings cannot be kept: neither XDG_CONFIG_HOME nor HOME is set");
  nlohmann::json json = {{"last_map", settings.last_map}, {"last_source", settings.last_source}};
  if (settings.ui_scale) json["ui_scale"] = *settings.ui_scale;
  make_folder(file.parent_path());
  AtomicFile written(file);
  // A path need not be UTF-8.
  written.stream() << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  written.commit();
}

}  // namespace roomradar
