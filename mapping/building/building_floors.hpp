// building_floors.hpp: the heights of a building's floors.
#pragma once
#include <span>
#include <vector>

#include "mapping/map/level_surfaces.hpp"

namespace roomradar {

struct BuildingFloor {
  double height_m = 0.0;  ///< z in the building's world
  double area_m2 = 0.0;   ///< of the level surfaces within 10 cm of the height
};

/// Returns the floors, from the lowest. A floor is the height with the most area of level surface within 10
/// cm, has at least a tenth of the largest floor's area, and is at least 2 m from floors with more area.
/// Table tops and steps between two parts of a storey are thus no floors.
std::vector<BuildingFloor> floors_among(std::span<const LevelSurface> surfaces);

}  // namespace roomradar
