// presets.hpp: qualities that were measured, by name, and in a row from accurate to fast; a file of them.
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

/// What was measured, by the name that says what and in which unit.
using Figures = std::map<std::string, double>;

struct Preset {
  ScanQuality scan;
  RunQuality run;
  Figures figures;
};

/// A setting of a run that no other is both faster and more accurate than.
struct FrontStep {
  RunQuality run;
  /// Median time of each FramePart over that with the default quality, measured beside it; > 0.
  std::array<double, kFrameParts> part_ratios{1.0, 1.0, 1.0, 1.0};
  /// In the room when these were measured, for objects that take turns to be moved; 0: not known.
  int objects = 0;
  Figures figures;
};

struct Presets {
  std::map<std::string, std::string> made_by;  ///< machine, renderer, command; free text
  std::map<std::string, Preset> presets;
  std::vector<FrontStep> front;  ///< from accurate to fast
};

/// Reads a file:
///
///     {"format": "roomradar presets", "format_version": 1, "made_by": {"machine": "...", ...},
///      "presets": {"fast": {"scan": {"resolution_m": 0.02}, "run": {"depth_stride": 2}, "figures":
///      {"frame_ratio": 0.4}}}, "front": [{"run": {}, "part_ratios": {"locate": 1, "mesh": 1, "physics": 1,
///      "compose": 1}, "objects": 50, "figures": {}}]}
///
/// Settings that are left out are the default's. Throws Error "FILE: ..." for what is not this: cut short, of
/// another version, longer than 1 MiB, a key that is not known, a value out of its rule.
Presets read_presets(const std::filesystem::path& path);
/// The same from text; `where` stands for the file's name in messages.
Presets presets_of(std::string_view text, const std::string& where);

/// Writes all of it, every setting by its name. Throws Error if the file cannot be written.
void write_presets(const Presets& presets, const std::filesystem::path& path);

/// The file that is given, or else that which comes with the program: presets.json beside it, or where it is
/// installed. Throws Error if there is none.
std::filesystem::path presets_file(const std::string& given);

/// Throws Error naming those that there are.
const Preset& preset_named(const Presets& presets, const std::string& name, const std::string& where);

}  // namespace roomradar
