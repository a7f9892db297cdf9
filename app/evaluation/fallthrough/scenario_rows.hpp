// scenario_rows.hpp: results of scenarios as a file, so that several processes can share a run.
#pragma once
#include <filesystem>
#include <vector>

#include "app/evaluation/fallthrough/totals.hpp"

namespace roomradar {

/// Writes rows as JSON. Every number reads back as the same number. Throws Error if the file cannot be
/// written.
void write_rows(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path);

/// Reads what write_rows() wrote. Throws Error if the file cannot be read or is of another form.
std::vector<ScenarioRow> read_rows(const std::filesystem::path& path);

}  // namespace roomradar
