// radar_bench_shapes.hpp: the depth frame, the moving objects and the things in the way that radar_bench
// measures on.
#pragma once
#include <string>
#include <vector>

#include "app/objects/published_objects.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar::bench {

/// A depth image and the surface through every stride-th of its pixels: two triangles a cell, jumps included,
/// as the published radar has them. The world is the camera's frame.
struct FrameScene {
  Intrinsics camera;
  DepthImage depth_m;
  int stride_px = 1;
  Mesh mesh;  ///< vertices row by row, (width - 1) / stride + 1 a row
};

/// A table with things on it before a wall, as from a hand-held sensor, with a little noise; 640 x 480.
FrameScene table_frame(int stride_px);

struct Sensor {
  std::string name;
  Mesh mesh;
};

/// A drinking cup with thick walls, open above: 8 cm wide, 10 cm high.
Mesh cup_mesh();
/// Seat, back and four legs, each a closed box: 45 cm wide, 90 cm high.
Mesh chair_mesh();
/// Sticks that point everywhere within a cube of 2 m: 40 cm long, 1 to 3 cm thick. tips_m: an end of each.
Mesh sticks_mesh(int count, unsigned seed, std::vector<Eigen::Vector3d>& tips_m);

/// 12, 6,256 and 181,412 triangles: a cube of 15 cm, the torus coarse and fine.
std::vector<Sensor> sensors();
/// 12 triangles around the torus.
Sensor torus_sized_box();
/// Torus (6,256 triangles), cup and chair.
std::vector<Sensor> concave_sensors();

}  // namespace roomradar::bench
