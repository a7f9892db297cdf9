// scenario_rows.hpp: file with the results of scenarios, so that several processes can divide a run.
#pragma once
#include <filesystem>
#include <vector>

#include "app/evaluation/fallthrough/totals.hpp"

namespace roomradar {

/// Writes rows as JSON. read_rows() reads exactly the same numbers. Throws Error if the file cannot be
/// written.
void write_rows(const std::vector<ScenarioRow>& rows, const std::filesystem::path& path);

/// Reads what write_rows() wrote. Throws Error if the file cannot be read or its contents are not such rows.
std::vector<ScenarioRow> read_rows(const std::filesystem::path& path);

}  // namespace roomradar
