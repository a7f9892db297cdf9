// radar_bench_shapes.hpp: depth frame, moving objects and obstacles for radar_bench.
#pragma once
#include <string>
#include <vector>

#include "app/objects/published_objects.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar::bench {

/// A depth image and the surface through every stride-th pixel: two triangles per cell, including depth
/// discontinuities, as in the published radar. The world is the camera's frame.
struct FrameScene {
  Intrinsics camera;
  DepthImage depth_m;
  int stride_px = 1;
  Mesh mesh;  ///< vertices row by row, (width - 1) / stride + 1 per row
};

/// A table with objects in front of a wall, as from a hand-held sensor, with a little noise; 640 x 480.
FrameScene table_frame(int stride_px);

struct Sensor {
  std::string name;
  Mesh mesh;
};

/// A drinking cup with thick walls, open at the top: 8 cm wide, 10 cm high.
Mesh cup_mesh();
/// Seat, back and four legs, each a closed box: 45 cm wide, 90 cm high.
Mesh chair_mesh();
/// Sticks in random directions within a cube of 2 m: 40 cm long, 1 to 3 cm thick. tips_m receives one end of
/// each.
Mesh sticks_mesh(int count, unsigned seed, std::vector<Eigen::Vector3d>& tips_m);

/// 12, 6,256 and 181,412 triangles: a cube of 15 cm, the coarse torus and the fine torus.
std::vector<Sensor> sensors();
/// A box of 12 triangles around the torus.
Sensor torus_sized_box();
/// Torus (6,256 triangles), cup and chair.
std::vector<Sensor> concave_sensors();

}  // namespace roomradar::bench
