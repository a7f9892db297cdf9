// dynamic_bench_mesh.hpp: rows on the mesh of what moved: how few triangles, how near, how long.
#pragma once
#include <nlohmann/json.hpp>

namespace roomradar::test {

/// Segmentation and mesh of a frame a fifth of which moved, with what a mesh of each pixel and one of the
/// whole frame cost beside it, all with the radar's tree.
void measure_mesh_times(nlohmann::json& rows);

/// Movers in simulated rooms: triangles against the mesh of every pixel, and how far one is from the other,
/// in sigmas of the sensor's noise at that depth and angle.
void measure_mesh_quality(nlohmann::json& rows);

}  // namespace roomradar::test
