// room_mesh.hpp: triangle mesh of a room's solids, used as the ground truth of mapped surfaces.
#pragma once
#include "app/sim/room/room.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Max distance of a triangle from the curved surface that it approximates. Vertices lie on the surface.
inline constexpr double kMeshDeviation_m = 0.0005;

/// Appends the closed surface of one solid. Triangles are counter-clockwise seen from outside. Vertices are
/// relative to the mesh's origin.
void append_mesh(const Solid& solid, Rgb colour, double deviation_m, Mesh& mesh);

/// Returns a mesh of all solids of a room. Each solid's surface is closed. Where two solids touch, both
/// surfaces are included.
Mesh room_mesh(const Room& room, double deviation_m = kMeshDeviation_m);

}  // namespace roomradar
