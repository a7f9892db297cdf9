// published_objects.cpp: fixed shapes; changing them would break comparison with earlier results.
#include "app/objects/published_objects.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace roomradar {

Mesh box_mesh(const Eigen::Vector3f& size_m) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f corner((i & 1) != 0 ? 0.5F : -0.5F, (i & 2) != 0 ? 0.5F : -0.5F,
                                 (i & 4) != 0 ? 0.5F : -0.5F);
    mesh.vertices.push_back(corner.cwiseProduct(size_m));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh bumpy_torus(int around, int across) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = kTurn * i / around, b = kTurn * j / across;
      const double tube_m = 0.035 + 0.01 * std::sin(7.0 * a) * std::sin(5.0 * b);
      const double r_m = 0.08 + tube_m * std::cos(b);
      mesh.vertices.push_back(
          Eigen::Vector3d(r_m * std::cos(a), r_m * std::sin(a), tube_m * std::sin(b)).cast<float>());
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

std::vector<Mesh> published_objects() {
  const Mesh torus = bumpy_torus(68, 46);
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& vertex : torus.vertices) bounds.extend(vertex);
  return {box_mesh(bounds.sizes()), torus, bumpy_torus(434, 209)};
}

}  // namespace roomradar
