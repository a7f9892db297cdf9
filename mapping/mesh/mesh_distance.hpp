// mesh_distance.hpp: how far the surfaces of two meshes lie apart, as a measured fact.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A mesh's triangles sorted into cubes, to find the surface near a point. Keeps a reference to the mesh.
class SurfaceNear {
 public:
  /// Distances up to reach_m (> 0) can be asked for.
  SurfaceNear(const Mesh& mesh, float reach_m);

  /// From a point, relative to the mesh's origin, to the nearest surface (m), or infinity if that is farther
  /// than reach_m. What is not farther than enough_m need not be the nearest: the search ends there.
  [[nodiscard]] float distance_m(const Eigen::Vector3f& p, float enough_m = 0.0F) const;

  /// The triangle nearest to a point among those within reach_m whose front is turned less than 90 degrees
  /// from `facing` (any length): of a thin sheet not the other side. None if there is none.
  [[nodiscard]] std::optional<std::uint32_t> nearest_facing(const Eigen::Vector3f& p,
                                                            const Eigen::Vector3f& facing) const;

 private:
  struct Entry {
    std::uint32_t cube;  // part of its code
    std::uint32_t triangle;
  };
  /// Calls visit(code) for each cube that the triangle's parts touch with their boxes.
  template <typename Visit>
  void for_each_cube(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                     const Visit& visit) const;

  /// Calls visit(triangle) for each that may be within reach of the point, until it says true.
  template <typename Visit>
  void visit_near(const Eigen::Vector3f& p, const Visit& visit) const;

  [[nodiscard]] std::size_t hash_of(std::uint64_t mixed) const { return mixed >> hash_shift_; }

  const Mesh& mesh_;
  float reach_m_;
  float edge_m_;
  int hash_shift_ = 63;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  std::vector<std::uint32_t> first_of_hash_;  ///< in entries_
  std::vector<Entry> entries_;                ///< by the hash of their cubes
};

/// A point of `mesh` that lies too far from another surface.
struct FarPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to the mesh's origin
  float distance_m = 0.0F;                             ///< infinity beyond the reach of `other`
};

/// Asks at all corners of `mesh` and on a lattice over its triangles no wider than spacing_m how far `other`
/// is (of the same origin). Gives the greatest distance not above limit_m; the points farther than that are
/// added to beyond_limit.
float greatest_distance_m(const Mesh& mesh, const SurfaceNear& other, float spacing_m, float limit_m,
                          std::vector<FarPoint>& beyond_limit);

}  // namespace roomradar
