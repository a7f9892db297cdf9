// flat_faces.cpp: region growing over neighbouring triangles.
#include "radar/geometry/flat_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace roomradar {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Returns the triangle beyond each side; kNone unless there is exactly one with consistent orientation.
std::vector<std::uint32_t> neighbours_of(std::size_t triangle_count, const std::vector<HalfEdge>& edges) {
  std::vector<std::uint32_t> beyond(3 * triangle_count, kNone);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].edge == edges[i].edge) ++end;
    if (end - i == 2 && edges[i].sense != edges[i + 1].sense) {
      beyond[edges[i].side] = edges[i + 1].side / 3;
      beyond[edges[i + 1].side] = edges[i].side / 3;
    }
    i = end;
  }
  return beyond;
}

/// Grows flat faces triangle by triangle (region growing).
class FaceFinder {
 public:
  FaceFinder(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
             const std::vector<HalfEdge>& edges, double flat_m)
      : triangles_(triangles),
        vertices_(vertices),
        beyond_(neighbours_of(triangles.size(), edges)),
        flat_m_(flat_m) {}

  /// Returns for each triangle whether it is within a face.
  std::vector<bool> find() {
    face_.assign(triangles_.size(), kNone);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (face_[t] == kNone) grow_from(t);
    std::vector<bool> within(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto is_of_its_face = [&](std::uint32_t next) {
        return next != kNone && face_[next] == face_[t];
      };
      within[t] = std::all_of(&beyond_[3 * t], &beyond_[3 * t] + 3, is_of_its_face);
    }
    return within;
  }

 private:
  /// Area-weighted plane of the triangles so far: the more triangles, the less their rounding tilts it.
  struct Plane {
    Eigen::Vector3d area_m2 = Eigen::Vector3d::Zero(), moment_m3 = Eigen::Vector3d::Zero();
    double weight_m2 = 0.0;

    void add(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& area) {
      const double weight = area.norm();
      area_m2 += area;
      moment_m3 += weight / 3.0 * (corners[0] + corners[1] + corners[2]);
      weight_m2 += weight;
    }
    [[nodiscard]] bool holds(const std::array<Eigen::Vector3d, 3>& corners, double within_m) const {
      const Eigen::Vector3d normal = area_m2.stableNormalized(), middle = moment_m3 / weight_m2;
      return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& p) {
        return std::abs(normal.dot(p - middle)) <= within_m;
      });
    }
  };

  const std::vector<Triangle>& triangles_;
  const std::vector<Eigen::Vector3f>& vertices_;
  const std::vector<std::uint32_t> beyond_;
  const double flat_m_;
  std::vector<std::uint32_t> face_, taken_;

  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t t) const {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return vertices_[triangles_[t][i]].cast<double>();
    };
    return {corner(0), corner(1), corner(2)};
  }
  static Eigen::Vector3d area(const std::array<Eigen::Vector3d, 3>& p) {
    return (p[1] - p[0]).cross(p[2] - p[0]);
  }

  void grow_from(std::uint32_t seed) {
    constexpr double kSameWay = 0.99;  // cosine: normals of slivers are rough, normals of folds are opposite
    Plane plane;
    plane.add(corners(seed), area(corners(seed)));
    face_[seed] = seed;
    taken_.assign(1, seed);
    for (std::size_t at = 0; at < taken_.size(); ++at) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t next = beyond_[3 * taken_[at] + i];
        if (next == kNone || face_[next] != kNone) continue;
        const auto p = corners(next);
        const Eigen::Vector3d a = area(p);
        if (!(a.dot(plane.area_m2) > kSameWay * a.norm() * plane.area_m2.norm()) || !plane.holds(p, flat_m_))
          continue;
        plane.add(p, a);
        face_[next] = seed;
        taken_.push_back(next);
      }
    }
    // The plane may have tilted away from the first triangles.
    const bool is_flat = std::all_of(taken_.begin(), taken_.end(),
                                     [&](std::uint32_t t) { return plane.holds(corners(t), 2.0 * flat_m_); });
    if (!is_flat)
      for (const std::uint32_t t : taken_) face_[t] = t;
  }
};

}  // namespace

std::vector<bool> find_within_flat_faces(const std::vector<Triangle>& triangles,
                                         const std::vector<Eigen::Vector3f>& vertices,
                                         const std::vector<HalfEdge>& edges, double flat_m) {
  return FaceFinder(triangles, vertices, edges, flat_m).find();
}

void mark_flat_faces(const std::vector<bool>& within, std::vector<TreeNode>& nodes) {
  for (std::size_t n = nodes.size(); n-- > 0;) {
    TreeNode& node = nodes[n];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      bool is_within = true;
      if (node.count[i] == 0) {
        const TreeNode& child = nodes[node.first[i]];
        is_within = child.within_faces == (1U << child.child_count) - 1U;
      }
      for (std::uint32_t t = node.first[i]; t < node.first[i] + node.count[i]; ++t)
        is_within = is_within && within[t];
      if (is_within) node.within_faces |= 1U << i;
    }
  }
}

}  // namespace roomradar
