// quality_options.hpp: options for the fields of ScanQuality and RunQuality, and --preset.
#pragma once
#include <string>

#include "app/quality/quality.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// Adds one option per field of ScanQuality. Parsing checks the values and appends them to `fixed`, which
/// must outlive the parsing. complete_quality() then sets the fields from `fixed`.
void add_scan_quality_options(CLI::App& command, FieldWords& fixed);
/// Adds one option per field of RunQuality, as add_scan_quality_options() does.
void add_run_quality_options(CLI::App& command, FieldWords& fixed);

/// Adds --preset and --presets.
/// @param[out] preset   the preset's name
/// @param[out] presets  the presets file
void add_preset_options(CLI::App& command, std::string& preset, std::string& presets);

/// Sets `quality` to that of the preset if a name is given. Then sets the fields in `fixed`. Throws Error if
/// the presets file cannot be read or has no such preset.
/// @param preset   name of the preset; empty: none
/// @param presets  presets file; empty: see presets_file()
void complete_quality(ScanQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed);
/// Sets the quality of a run, as for a scan.
void complete_quality(RunQuality& quality, const std::string& preset, const std::string& presets,
                      const FieldWords& fixed);

}  // namespace roomradar
