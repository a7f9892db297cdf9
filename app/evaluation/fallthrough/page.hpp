// page.hpp: writes a run's HTML file: table, plots, pictures of failures.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/totals.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct FailurePicture {
  std::string caption;
  ColourImage picture;
};

/// Writes a self-contained file that needs no network. Does nothing if the path is empty. Throws Error if it
/// cannot be written.
/// @param about  a line that names scenarios, seed, rooms and machine
void write_page(const std::vector<ScenarioRow>& rows, const std::string& about,
                const std::vector<FailurePicture>& pictures, const std::filesystem::path& path);

}  // namespace roomradar
