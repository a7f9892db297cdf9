// quality_options.hpp: options for the fields of a scan's or run's quality, and --preset.
#pragma once
#include <string>

#include "app/quality/quality.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// Adds one option per field of the scan quality, and the fields' former names. The parser checks the values
/// and appends them to `fixed`, which must outlive the parsing. complete_quality() then sets the fields from
/// it.
void add_scan_quality_options(CLI::App& command, FieldWords& fixed);
/// Adds one option per field of the run quality, in the same way.
void add_run_quality_options(CLI::App& command, FieldWords& fixed);

/// Adds --preset and --presets.
/// @param[out] preset   the preset's name
/// @param[out] presets  the presets file
void add_preset_options(CLI::App& command, std::string& preset, std::string& presets);

/// Sets the quality to that of the named preset, if a name is given, then sets the fields of `fixed`. Throws
/// Error if the presets file cannot be read or has no such preset.
/// @param preset   name; empty: the quality is not replaced
/// @param presets  file; empty: the program's own
void complete_quality(ScanQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed);
/// Sets the quality of a run in the same way.
void complete_quality(RunQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed);

}  // namespace roomradar
