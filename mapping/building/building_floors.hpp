// building_floors.hpp: the heights of a building's floors.
#pragma once
#include <span>
#include <vector>

#include "mapping/map/level_surfaces.hpp"

namespace roomradar {

struct BuildingFloor {
  double height_m = 0.0;  ///< z in the building's world frame
  double area_m2 = 0.0;   ///< area of the level surfaces within 10 cm of the height
};

/// Returns the floors, the lowest first. A floor is a height at which the area of level surfaces within 10 cm
/// has a maximum. Its area must be at least a tenth of the largest floor's. Its distance to each floor with
/// more area must be at least 2 m. These limits exclude table tops, and steps within a storey.
std::vector<BuildingFloor> floors_among(std::span<const LevelSurface> surfaces);

}  // namespace roomradar
