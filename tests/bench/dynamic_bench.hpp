// dynamic_bench.hpp: what dynamic_bench measures: accuracy of the foreground, on simulated movers and in
// recordings without motion; the mesh of the dynamic foreground: number of triangles, distance from the
// truth, time.
#pragma once
#include <nlohmann/json.hpp>

namespace roomradar::test {

using Rows = nlohmann::json;  ///< an array of objects, one per measured cell

/// Appends rows: masks of hand, ball and person against the truth; a hand 1 to 20 cm above a table; pixels
/// marked in recordings without motion. For an absent recording, prints a message and appends no row.
void measure_foreground(Rows& rows);

/// Times segmentation and meshing of a frame of which a fifth moved. For comparison, times a mesh of every
/// pixel and a mesh of the whole frame. All include the radar's tree.
void measure_mesh_times(nlohmann::json& rows);

/// Movers in simulated rooms: number of triangles compared with the mesh of every pixel, and distance between
/// the two meshes, in sigmas of the sensor's noise at that depth and angle.
void measure_mesh_quality(nlohmann::json& rows);

}  // namespace roomradar::test
