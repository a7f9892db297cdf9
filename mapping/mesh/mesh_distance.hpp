// mesh_distance.hpp: nearest-surface queries on a mesh, and measurement of the distance between two meshes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Hashed grid of a mesh's triangles, for nearest-surface queries. Keeps a reference to the mesh.
class MeshDistanceQuery {
 public:
  /// @param reach_m  max distance that queries can find, m, > 0
  MeshDistanceQuery(const Mesh& mesh, float reach_m);

  /// Returns the distance (m) from a point, given relative to the mesh's origin, to the nearest surface.
  /// Returns infinity if the distance exceeds reach_m. The search stops at the first distance that is at most
  /// enough_m. With enough_m > 0, the result thus need not be the smallest distance.
  [[nodiscard]] float distance_m(const Eigen::Vector3f& p, float enough_m = 0.0F) const {
    std::uint32_t guess = kNoGuess;
    return distance_m(p, enough_m, guess);
  }
  /// The same; faster if `guess`, the index of a triangle, is near the point. Sets it to the one found.
  [[nodiscard]] float distance_m(const Eigen::Vector3f& p, float enough_m, std::uint32_t& guess) const;

  /// Returns the nearest triangle within reach_m whose normal is less than 90 degrees from `facing` (any
  /// length). The far side of a thin sheet is thus skipped. Returns nullopt if there is none. Faster if
  /// `guess`, the index of a triangle, is near the point; sets it to the one found.
  [[nodiscard]] std::optional<std::uint32_t> nearest_facing(const Eigen::Vector3f& p,
                                                            const Eigen::Vector3f& facing,
                                                            std::uint32_t& guess) const;
  static constexpr std::uint32_t kNoGuess = ~std::uint32_t{0};

 private:
  struct Entry {
    std::uint32_t cube;  // some bits of the cube's hash
    std::uint32_t triangle;
  };
  /// Calls visit(key) for the grid cubes that the triangle may overlap. Splits a large triangle, and visits
  /// the cubes that the bounding boxes of its parts overlap.
  template <typename Visit>
  void for_each_cube(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                     const Visit& visit) const;

  /// Calls visit(triangle) for each triangle that may be within radius_m of the point, until visit returns
  /// true.
  template <typename Visit>
  void visit_near(const Eigen::Vector3f& p, float radius_m, const Visit& visit) const;

  /// Bounding sphere of a triangle.
  struct Sphere {
    Eigen::Vector3f centre;
    float radius_m;
  };
  /// Conservative test by the bounding sphere: true only if the triangle is farther from p than distance_m.
  /// Rejects most triangles of a cube without a look-up of their vertices.
  [[nodiscard]] bool is_farther(std::uint32_t triangle, const Eigen::Vector3f& p, float distance_m) const {
    constexpr float kRounding = 1.0001F;
    const Sphere& sphere = spheres_[triangle];
    const float reach_m = sphere.radius_m + distance_m;
    return (p - sphere.centre).squaredNorm() > kRounding * reach_m * reach_m;
  }
  [[nodiscard]] float squared_distance(std::uint32_t triangle, const Eigen::Vector3f& p) const;
  [[nodiscard]] bool faces(std::uint32_t triangle, const Eigen::Vector3f& facing) const;
  [[nodiscard]] std::size_t hash_of(std::uint64_t mixed) const { return mixed >> hash_shift_; }

  const Mesh& mesh_;
  float reach_m_;
  float edge_m_;
  int hash_shift_ = 63;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  std::vector<std::uint32_t> first_of_hash_;  ///< first index into entries_ per hash
  std::vector<Entry> entries_;                ///< sorted by the hash of their cubes
  std::vector<Sphere> spheres_;               ///< one per triangle
};

/// A point of one mesh that is farther than a limit from the surface of another.
struct FarPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to the mesh's origin
  float distance_m = 0.0F;                             ///< infinity if it exceeds the reach of `other`
};

/// Measures the distance to `other` (same origin) at all used vertices of `mesh`, and on a lattice over its
/// triangles with at most spacing_m between points. Returns the largest distance that is at most limit_m.
/// Appends points farther away to beyond_limit.
float greatest_distance_m(const Mesh& mesh, const MeshDistanceQuery& other, float spacing_m, float limit_m,
                          std::vector<FarPoint>& beyond_limit);

}  // namespace roomradar
