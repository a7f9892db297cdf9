// start_settings.hpp: settings that the start view remembers, in $XDG_CONFIG_HOME/roomradar/start.json.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace roomradar {

struct StartSettings {
  std::string last_map;            ///< folder; empty: none
  std::string last_source;         ///< in the syntax of open_source(); empty: none
  std::optional<double> ui_scale;  ///< scale of text and panes, 0.5..4; unset: that of the monitor

  friend bool operator==(const StartSettings&, const StartSettings&) = default;
};

struct ReadSettings {
  StartSettings settings;
  std::string fault;  ///< sentence on a fault of the file; empty: none
};

/// Returns the path of the settings file: in $XDG_CONFIG_HOME/roomradar, or ~/.config/roomradar if that
/// variable is not set to an absolute path. Returns an empty path if there is no home folder either.
std::filesystem::path start_settings_file();

/// Reads the settings. The file is untrusted: if it is damaged or has a value out of range, returns the
/// default settings and sets `fault`. If the file is missing, returns the default settings.
ReadSettings read_start_settings(const std::filesystem::path& file);

/// Writes the settings atomically. Creates the folder if it is missing. Throws Error naming the file and the
/// cause.
void write_start_settings(const StartSettings& settings, const std::filesystem::path& file);

}  // namespace roomradar
