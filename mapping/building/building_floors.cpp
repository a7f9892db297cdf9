// building_floors.cpp: picks heights by their area, the largest first.
#include "mapping/building/building_floors.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

constexpr double kSameFloor_m = 0.1;  // drift of a large building, and thresholds
constexpr double kMinStorey_m = 2.0;  // lower than any storey, higher than tables and cupboards' shelves
constexpr double kMinAreaPart = 0.1;  // of the largest floor

BuildingFloor floor_at(double height_m, std::span<const LevelSurface> surfaces) {
  BuildingFloor floor;
  double weighted_m3 = 0.0;
  for (const LevelSurface& surface : surfaces) {
    if (std::abs(surface.height_m - height_m) > kSameFloor_m) continue;
    floor.area_m2 += surface.area_m2;
    weighted_m3 += surface.area_m2 * surface.height_m;
  }
  floor.height_m = weighted_m3 / floor.area_m2;
  return floor;
}

}  // namespace

std::vector<BuildingFloor> floors_among(std::span<const LevelSurface> surfaces) {
  std::vector<BuildingFloor> candidates, floors;
  for (const LevelSurface& surface : surfaces) candidates.push_back(floor_at(surface.height_m, surfaces));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const BuildingFloor& a, const BuildingFloor& b) { return a.area_m2 > b.area_m2; });
  for (const BuildingFloor& candidate : candidates) {
    if (candidate.area_m2 < kMinAreaPart * candidates.front().area_m2) break;
    const bool is_apart = std::all_of(floors.begin(), floors.end(), [&](const BuildingFloor& floor) {
      return std::abs(floor.height_m - candidate.height_m) >= kMinStorey_m;
    });
    if (is_apart) floors.push_back(candidate);
  }
  std::sort(floors.begin(), floors.end(),
            [](const BuildingFloor& a, const BuildingFloor& b) { return a.height_m < b.height_m; });
  return floors;
}

}  // namespace roomradar
