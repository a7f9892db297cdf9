// building_summary.hpp: recordings, tiles, extents, floors and areas of a building, as text and as JSON.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/building/building_floors.hpp"
#include "mapping/building/building_info.hpp"

namespace roomradar {

struct BuildingSummary {
  BuildingInfo info;
  std::int64_t triangles = 0;
  std::uintmax_t bytes = 0;           ///< size of all files that building.json lists
  Eigen::AlignedBox3d surface_world;  ///< bounding box of the surface, m; empty if there is no tile
  double surface_m2 = 0.0;
  std::vector<BuildingFloor> floors;  ///< from the lowest
};

/// Reads building.json and, sequentially, the meshes of all tiles. Throws Error naming the file and the fault
/// if a file is missing or damaged.
BuildingSummary summarise_building(const std::filesystem::path& folder);

/// Returns lines of text, for the user.
std::string describe(const BuildingSummary& summary);
/// Returns the summary as an object, without the files' hashes.
nlohmann::json json_of(const BuildingSummary& summary);

}  // namespace roomradar
