// quality_options.hpp: options of the qualities, made from their lists of fields, and --preset.
#pragma once
#include <string>

#include "app/quality/quality.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// Adds one option per field of the quality, and the fields' former names. Checked values are appended to
/// `fixed`, which must outlive the parsing; complete_quality() sets the fields from it.
void add_scan_quality_options(CLI::App& command, FieldWords& fixed);
void add_run_quality_options(CLI::App& command, FieldWords& fixed);

/// Adds --preset and --presets.
/// @param preset   receives the preset's name
/// @param presets  receives the presets file
void add_preset_options(CLI::App& command, std::string& preset, std::string& presets);

/// Sets the quality to that of the named preset, if a name is given, then sets the fields of `fixed`. Throws
/// Error if the presets file cannot be read or has no such preset.
/// @param presets  file; empty: the program's own
void complete_quality(ScanQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed);
void complete_quality(RunQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed);

}  // namespace roomradar
