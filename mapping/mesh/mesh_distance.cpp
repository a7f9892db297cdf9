// mesh_distance.cpp: hashed grid of triangles, and sampling of a mesh.
#include "mapping/mesh/mesh_distance.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "mapping/mesh/triangle_distance.hpp"
#include "mapping/types/fibonacci_hash.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Cube edge / reach: a query visits one to eight cubes. With a long reach, cubes are only kSidesACube mean
// triangle sides wide, since most queries find a triangle much nearer than the reach; at most 125 cubes.
constexpr float kReachesACube = 4.0F, kSidesACube = 1.0F, kLeastReachesACube = 0.5F;
// Min cube edge, for very short reaches: mean triangle side / kCubesASide and mesh extent / kCubesAcross.
// Smaller cubes would put a triangle into countless cubes, or exceed float precision.
constexpr float kCubesASide = 3.0F, kCubesAcross = 1e5F;

// Mean over triangles of the longest side of their bounding boxes.
float mean_side_m(const Mesh& mesh) {
  double sum_m = 0.0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Eigen::Vector3f extents = a.cwiseMax(b).cwiseMax(c) - a.cwiseMin(b).cwiseMin(c);
    sum_m += static_cast<double>(extents.maxCoeff());
  }
  return mesh.triangles.empty() ? 0.0F
                                : static_cast<float>(sum_m / static_cast<double>(mesh.triangles.size()));
}

// Distinguishes cubes with equal hash (the upper bits of a mixed code). Cubes with equal hash and tag cost
// time but leave results correct.
std::uint32_t tag_of(std::uint64_t mixed_code) { return static_cast<std::uint32_t>(mixed_code >> 14U); }

}  // namespace

MeshDistanceQuery::MeshDistanceQuery(const Mesh& mesh, float reach_m)
    : mesh_(mesh), reach_m_(reach_m), edge_m_(kReachesACube * reach_m) {
  const float side_m = mean_side_m(mesh);
  edge_m_ = std::min(edge_m_, std::max(kSidesACube * side_m, kLeastReachesACube * reach_m));
  if (!mesh.vertices.empty()) {
    Eigen::Vector3f high = low_ = mesh.vertices.front();
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      low_ = low_.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    edge_m_ = std::max({edge_m_, side_m / kCubesASide, (high - low_).maxCoeff() / kCubesAcross});
  }
  spheres_.reserve(mesh.triangles.size());
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Eigen::Vector3f centre = (a + b + c) / 3.0F;
    const float radius_m = std::sqrt(
        std::max({(a - centre).squaredNorm(), (b - centre).squaredNorm(), (c - centre).squaredNorm()}));
    spheres_.push_back({centre, radius_m});
  }
  struct Part {
    std::uint64_t mixed_code;
    std::uint32_t triangle;
  };
  const auto for_each_part = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      for_each_cube(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c],
                    [&](std::uint64_t cube) { visit(cube, t); });
    }
  };
  std::size_t count = 0;  // counting them takes less time than letting `parts` grow
  for_each_part([&](std::uint64_t, std::uint32_t) { ++count; });
  std::vector<Part> parts;
  parts.reserve(count);
  for_each_part([&](std::uint64_t cube, std::uint32_t t) { parts.push_back({fibonacci_hash(cube), t}); });
  // About one hash value per triangle, more if triangles overlap very many cubes.
  const std::size_t hashes = std::max(mesh.triangles.size(), parts.size() / 4);
  hash_shift_ = 64 - static_cast<int>(std::bit_width(hashes | 1U));
  first_of_hash_.assign((std::size_t{1} << (64 - hash_shift_)) + 1, 0);
  for (const Part& part : parts) ++first_of_hash_[hash_of(part.mixed_code) + 1];
  for (std::size_t h = 1; h < first_of_hash_.size(); ++h) first_of_hash_[h] += first_of_hash_[h - 1];
  entries_.resize(parts.size());
  std::vector<std::uint32_t> next(first_of_hash_.begin(), first_of_hash_.end() - 1);
  for (const Part& part : parts)
    entries_[next[hash_of(part.mixed_code)]++] = {tag_of(part.mixed_code), part.triangle};
}

// Splits a large triangle along its longest side until its parts' boxes overlap few cubes.
template <typename Visit>
void MeshDistanceQuery::for_each_cube(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                      const Eigen::Vector3f& c, const Visit& visit) const {
  const auto cube_of = [&](const Eigen::Vector3f& p) -> Eigen::Array3i {
    return ((p - low_) / edge_m_).array().floor().cast<int>();
  };
  const Eigen::Array3i low = cube_of(a.cwiseMin(b).cwiseMin(c));
  const Eigen::Array3i high = cube_of(a.cwiseMax(b).cwiseMax(c));
  if ((high - low).maxCoeff() <= 1) {
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) visit(voxel_key(x, y, z));
    return;
  }
  const float ab = (b - a).squaredNorm();
  const float bc = (c - b).squaredNorm();
  const float ca = (a - c).squaredNorm();
  if (ab >= bc && ab >= ca) {
    for_each_cube(a, (a + b) / 2, c, visit);
    for_each_cube((a + b) / 2, b, c, visit);
  } else if (bc >= ca) {
    for_each_cube(b, (b + c) / 2, a, visit);
    for_each_cube((b + c) / 2, c, a, visit);
  } else {
    for_each_cube(c, (c + a) / 2, b, visit);
    for_each_cube((c + a) / 2, a, b, visit);
  }
}

template <typename Visit>
void MeshDistanceQuery::visit_near(const Eigen::Vector3f& p, float radius_m, const Visit& visit) const {
  const Eigen::Array3f place = (p - low_).array();
  const Eigen::Array3i low = ((place - radius_m) / edge_m_).floor().cast<int>();
  const Eigen::Array3i high = ((place + radius_m) / edge_m_).floor().cast<int>();
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const std::uint64_t wanted = fibonacci_hash(voxel_key(x, y, z));
        const std::size_t hash = hash_of(wanted);
        const std::uint32_t tag = tag_of(wanted);
        for (std::uint32_t i = first_of_hash_[hash]; i < first_of_hash_[hash + 1]; ++i)
          if (entries_[i].cube == tag && visit(entries_[i].triangle)) return;
      }
}

float MeshDistanceQuery::squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return squared_distance_to_triangle(p, mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
}

bool MeshDistanceQuery::faces(std::uint32_t triangle, const Eigen::Vector3f& facing) const {
  const auto& [i, j, k] = mesh_.triangles[triangle];
  const Eigen::Vector3f &a = mesh_.vertices[i], &b = mesh_.vertices[j], &c = mesh_.vertices[k];
  return (b - a).cross(c - a).dot(facing) > 0.0F;
}

float MeshDistanceQuery::distance_m(const Eigen::Vector3f& p, float enough_m, std::uint32_t& guess) const {
  float nearest = reach_m_ * reach_m_, nearest_m = reach_m_;
  bool found = false;
  const auto try_triangle = [&](std::uint32_t triangle) {
    const float distance = squared_distance(triangle, p);
    if (!(distance <= nearest)) return false;
    nearest = distance;
    nearest_m = std::sqrt(distance);
    found = true;
    guess = triangle;
    return distance <= enough_m * enough_m;
  };
  if (guess < mesh_.triangles.size() && try_triangle(guess)) return nearest_m;
  visit_near(p, nearest_m, [&](std::uint32_t triangle) {
    return !is_farther(triangle, p, nearest_m) && try_triangle(triangle);
  });
  return found ? nearest_m : kInfinity;
}

// The guess only limits the search: of several nearest triangles, the last one visited is found in any case.
std::optional<std::uint32_t> MeshDistanceQuery::nearest_facing(const Eigen::Vector3f& p,
                                                               const Eigen::Vector3f& facing,
                                                               std::uint32_t& guess) const {
  float nearest = reach_m_ * reach_m_;
  if (guess < mesh_.triangles.size() && faces(guess, facing))
    nearest = std::min(nearest, squared_distance(guess, p));
  float nearest_m = std::sqrt(nearest);
  std::optional<std::uint32_t> found;
  visit_near(p, nearest_m, [&](std::uint32_t triangle) {
    if (is_farther(triangle, p, nearest_m) || !faces(triangle, facing)) return false;
    const float distance = squared_distance(triangle, p);
    if (!(distance <= nearest)) return false;
    nearest = distance;
    nearest_m = std::sqrt(distance);
    found = guess = triangle;
    return false;
  });
  return found;
}

float greatest_distance_m(const Mesh& mesh, const MeshDistanceQuery& other, float spacing_m, float limit_m,
                          std::vector<FarPoint>& beyond_limit) {
  float greatest = 0.0F;  // smaller distances cannot raise it, so their search stops early
  std::uint32_t near = MeshDistanceQuery::kNoGuess;
  const auto ask = [&](const Eigen::Vector3f& p) {
    const float distance = other.distance_m(p, greatest, near);
    if (distance <= limit_m) greatest = std::max(greatest, distance);
    if (distance > limit_m) beyond_limit.push_back({p, distance});
  };
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& [i, j, k] : mesh.triangles) {
    used[i] = used[j] = used[k] = true;
    const Eigen::Vector3f& a = mesh.vertices[i];
    const Eigen::Vector3f ab = mesh.vertices[j] - a;
    const Eigen::Vector3f ac = mesh.vertices[k] - a;
    const float longest = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
    const int parts = std::max(2, static_cast<int>(std::ceil(longest / spacing_m)));
    // Includes the sides, along which surfaces bend; corners follow below, each once.
    const float step = 1.0F / static_cast<float>(parts);
    for (int u = 0; u <= parts; ++u)
      for (int v = u == 0 ? 1 : 0; u + v <= parts - (u == 0 || v == 0 ? 1 : 0); ++v)
        ask(a + static_cast<float>(u) * step * ab + static_cast<float>(v) * step * ac);
  }
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) ask(mesh.vertices[v]);
  return greatest;
}

}  // namespace roomradar
