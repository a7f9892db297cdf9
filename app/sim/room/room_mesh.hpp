// room_mesh.hpp: triangle mesh of a room's solids, the ground truth of a mapped surface.
#pragma once
#include "app/sim/room/room.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Max distance of a triangle from the curved surface it approximates. Vertices lie on the surface.
inline constexpr double kMeshDeviation_m = 0.0005;

/// Appends one solid's closed surface, counter-clockwise from outside, relative to the mesh's origin.
void append_mesh(const Solid& solid, Rgb colour, double deviation_m, Mesh& mesh);

/// Meshes all solids of a room, each closed: where two solids touch, both surfaces are included.
Mesh room_mesh(const Room& room, double deviation_m = kMeshDeviation_m);

}  // namespace roomradar
