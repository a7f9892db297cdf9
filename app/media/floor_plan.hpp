// floor_plan.hpp: draws a plan of each floor of a building.
#pragma once
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Draws the floors side by side, all to one scale, with their heights and a scale bar. +x is to the right,
/// +y up. Between 0.3 and 1.8 m above a floor, steep surfaces (walls, furniture) are dark and level surfaces
/// (table tops) are grey. The floor itself is light. Pixels without surface are white.
/// @param floor_heights_m  z of the floors, from the lowest
/// @param most_px          longest side of the picture, 300 to 16,000; the scale is at most 100 pixels per m
/// @return an empty image if the mesh or the list of floors is empty
ColourImage draw_floor_plans(const Mesh& mesh_world, std::span<const double> floor_heights_m,
                             int most_px = 5000);

}  // namespace roomradar
