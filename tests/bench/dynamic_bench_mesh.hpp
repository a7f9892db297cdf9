// dynamic_bench_mesh.hpp: mesh of the dynamic foreground: number of triangles, distance from the truth, time.
#pragma once
#include <nlohmann/json.hpp>

namespace roomradar::test {

/// Times segmentation and meshing of a frame of which a fifth moved. For comparison, times a mesh of every
/// pixel and a mesh of the whole frame. All include the radar's tree.
void measure_mesh_times(nlohmann::json& rows);

/// Movers in simulated rooms: number of triangles compared with the mesh of every pixel, and distance between
/// the two meshes, in sigmas of the sensor's noise at that depth and angle.
void measure_mesh_quality(nlohmann::json& rows);

}  // namespace roomradar::test
