// room_mesh.hpp: triangles of a room's solids, as ground truth of a mapped surface.
#pragma once
#include "app/sim/room/room.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// How far a flat triangle may be from the round surface it stands for. Vertices lie on the surface.
inline constexpr double kMeshDeviation_m = 0.0005;

/// Appends one solid's surface, closed, counter-clockwise from outside, relative to the mesh's origin.
void append_mesh(const Solid& solid, Rgb colour, double deviation_m, Mesh& mesh);

/// All solids of a room, each closed by itself: where one stands on another both surfaces are there.
Mesh room_mesh(const Room& room, double deviation_m = kMeshDeviation_m);

}  // namespace roomradar
