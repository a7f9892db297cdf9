// page.hpp: writes the HTML file of a fall-through test, with table, plots and pictures of failures.
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

/// Writes a self-contained file that loads nothing from the network. Does nothing if `path` is empty. Throws
/// Error if the file cannot be written.
/// @param about  text line with the number of scenarios, the seed, the rooms and the machine
void write_page(const std::vector<ScenarioRow>& rows, const std::string& about,
                const std::vector<FailurePicture>& pictures, const std::filesystem::path& path);

}  // namespace roomradar
