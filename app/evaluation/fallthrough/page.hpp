// page.hpp: one HTML file of a run: table, plots, pictures of what went wrong.
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

/// Needs no network and no other file. Throws Error if it cannot be written.
/// @param about  a line on what was run: scenarios, seed, rooms, machine
void write_page(const std::vector<ScenarioRow>& rows, const std::string& about,
                const std::vector<FailurePicture>& pictures, const std::filesystem::path& path);

}  // namespace roomradar
