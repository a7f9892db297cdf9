// presets.hpp: file with measured quality settings, that is, named presets and a Pareto front from accurate
// to fast.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"

namespace roomradar {

/// Measured values by name; the name includes the unit.
using Figures = std::map<std::string, double>;

struct Preset {
  ScanQuality scan;
  RunQuality run;
  Figures figures;
};

/// Pareto-optimal settings of a run. No other measured settings are both faster and more accurate.
struct FrontStep {
  RunQuality run;
  /// Median time of each FramePart divided by its time at the default quality in the same measurement; > 0.
  std::array<double, kFrameParts> part_ratios{1.0, 1.0, 1.0, 1.0};
  /// Number of objects in the room during the measurement. Corrects the physics ratio for the current number
  /// of objects, if move_every_n_frames > 1. 0: unknown, no correction.
  int objects = 0;
  Figures figures;
};

struct Presets {
  /// Machine, renderer and command of the measurement; free text.
  std::map<std::string, std::string> made_by;
  std::map<std::string, Preset> presets;
  std::vector<FrontStep> front;  ///< from accurate to fast
};

/// Reads a presets file, such as:
///
///     {"format": "roomradar presets", "format_version": 1, "made_by": {"machine": "...", ...},
///      "presets": {"fast": {"scan": {"resolution_m": 0.02}, "run": {"depth_stride": 2}, "figures":
///      {"frame_ratio": 0.4}}}, "front": [{"run": {}, "part_ratios": {"locate": 1, "mesh": 1, "physics": 1,
///      "compose": 1}, "objects": 50, "figures": {}}]}
///
/// Omitted settings have their defaults. Throws Error "FILE: ..." if the file is truncated, has another
/// version or more than 1 MiB. Also throws for an unknown key or a value out of range.
Presets read_presets(const std::filesystem::path& path);
/// Parses the text of a presets file. Error messages contain `where` in place of the file's name.
Presets presets_of(std::string_view text, const std::string& where);

/// Writes all presets with all settings, defaults included. Throws Error if the file cannot be written.
void write_presets(const Presets& presets, const std::filesystem::path& path);

/// Returns `given` if it is not empty. Otherwise returns the path of the program's presets.json, in the
/// executable's folder or in the installed location. Throws Error if there is none.
std::filesystem::path presets_file(const std::string& given);

/// Returns the preset of this name. If no preset has the name, throws Error that lists the existing names.
const Preset& preset_named(const Presets& presets, const std::string& name, const std::string& where);

}  // namespace roomradar
