// mesh_simplify.cpp: collapse, measure, and do again with less tolerance where it came out too far apart.
#include "mapping/mesh_simplify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapping/edge_collapse.hpp"
#include "mapping/mesh_distance.hpp"

namespace roomradar {
namespace {

// Vertices are held nearer than the bound, as the surface between them lies farther off here and there; with
// more, repairs cost more triangles than this saves.
constexpr float kOfBound = 0.6F;
constexpr int kMostRounds = 10;
constexpr float kTightening = 0.4F;
constexpr float kLeastOfBound = 0.2F;  // below, a vertex is kept as it is

// Lessens the tolerance of all vertices within radius_m of a far point.
void tighten_around(const Mesh& mesh, const std::vector<FarPoint>& far, float radius_m, float least_m,
                    std::vector<float>& tolerance_m) {
  const auto cube_of = [&](const Eigen::Vector3f& p) -> Eigen::Array3i {
    return (p / radius_m).array().floor().cast<int>();
  };
  const auto code = [](const Eigen::Array3i& cube) {
    const auto field = [](int i) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) & 0x1F'FFFFU;
    };
    return field(cube.x()) | field(cube.y()) << 21U | field(cube.z()) << 42U;
  };
  std::unordered_multimap<std::uint64_t, std::size_t> in_cube;
  for (std::size_t i = 0; i < far.size(); ++i) in_cube.emplace(code(cube_of(far[i].position)), i);
  const auto is_near = [&](const Eigen::Vector3f& p) {
    for (int n = 0; n < 27; ++n) {
      const auto [begin, end] =
          in_cube.equal_range(code(cube_of(p) + Eigen::Array3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (std::any_of(begin, end, [&](const auto& entry) {
            return (far[entry.second].position - p).squaredNorm() <= radius_m * radius_m;
          }))
        return true;
    }
    return false;
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_near(mesh.vertices[v])) continue;
    tolerance_m[v] *= kTightening;
    if (tolerance_m[v] < least_m) tolerance_m[v] = 0.0F;
  }
}

}  // namespace

SimplifiedMesh simplified(const Mesh& mesh, float max_deviation_m, float spacing_m) {
  if (mesh.triangles.empty()) return {mesh, 0.0F};
  const SurfaceNear full_surface(mesh, max_deviation_m);
  std::vector<float> tolerance_m(mesh.vertices.size(), kOfBound * max_deviation_m);
  float radius_m = spacing_m;
  for (int round = 0; round < kMostRounds; ++round, radius_m *= 1.5F) {
    SimplifiedMesh result{collapsed(mesh, full_surface, tolerance_m), 0.0F};
    std::vector<FarPoint> far;
    result.deviation_m = greatest_distance_m(result.mesh, full_surface, spacing_m, max_deviation_m, far);
    if (far.empty()) {
      const SurfaceNear simple_surface(result.mesh, max_deviation_m);
      result.deviation_m = std::max(
          result.deviation_m, greatest_distance_m(mesh, simple_surface, spacing_m, max_deviation_m, far));
      if (far.empty()) return result;
    }
    tighten_around(mesh, far, radius_m, kLeastOfBound * max_deviation_m, tolerance_m);
  }
  return {mesh, 0.0F};  // no room was seen to need so many; the bound comes first
}

}  // namespace roomradar
