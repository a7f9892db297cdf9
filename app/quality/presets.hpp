// presets.hpp: file of measured qualities: named presets, and a Pareto front from accurate to fast.
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

/// Pareto-optimal setting of a run: no other setting is both faster and more accurate.
struct FrontStep {
  RunQuality run;
  /// Median time of each FramePart relative to the default quality in the same measurement; > 0.
  std::array<double, kFrameParts> part_ratios{1.0, 1.0, 1.0, 1.0};
  /// Number of objects in the room during the measurement, for settings with move_every_n_frames; 0: unknown.
  int objects = 0;
  Figures figures;
};

struct Presets {
  std::map<std::string, std::string> made_by;  ///< machine, renderer, command; free text
  std::map<std::string, Preset> presets;
  std::vector<FrontStep> front;  ///< from accurate to fast
};

/// Reads a file of the form:
///
///     {"format": "roomradar presets", "format_version": 1, "made_by": {"machine": "...", ...},
///      "presets": {"fast": {"scan": {"resolution_m": 0.02}, "run": {"depth_stride": 2}, "figures":
///      {"frame_ratio": 0.4}}}, "front": [{"run": {}, "part_ratios": {"locate": 1, "mesh": 1, "physics": 1,
///      "compose": 1}, "objects": 50, "figures": {}}]}
///
/// Omitted settings have their defaults. Throws Error "FILE: ..." if the file is cut short, of another
/// version or longer than 1 MiB, or has an unknown key or a value out of range.
Presets read_presets(const std::filesystem::path& path);
/// Parses the text of a presets file; `where` replaces the file's name in messages.
Presets presets_of(std::string_view text, const std::string& where);

/// Writes all presets, with every setting. Throws Error if the file cannot be written.
void write_presets(const Presets& presets, const std::filesystem::path& path);

/// Returns `given`; if empty, the program's own presets.json: beside the executable, or in its installed
/// location. Throws Error if there is none.
std::filesystem::path presets_file(const std::string& given);

/// Throws Error listing the existing names if there is no such preset.
const Preset& preset_named(const Presets& presets, const std::string& name, const std::string& where);

}  // namespace roomradar
