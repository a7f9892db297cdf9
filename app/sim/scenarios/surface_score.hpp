// surface_score.hpp: accuracy and completeness of a reconstructed mesh relative to the simulated room's
// surface.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Max distance at which mesh and true surface count as coincident.
inline constexpr double kSurfaceFound_m = 0.02;

/// Points of a room's true surface that depth frames measured within 5 m, at most one per cube of side
/// kSurfaceFound_m. Every 4th row and column of the depth images is used.
class SeenSurface {
 public:
  /// Adds a frame of a simulated source, with its ground truth. Pixels of moving objects are ignored.
  void add(const Frame& frame, const SimTruth& truth);

  /// Returns the points that at least three frames measured, in the room's coordinate frame.
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;

 private:
  struct Seen {
    Eigen::Vector3d point;
    std::int64_t last_frame = -1;
    int frames = 0;
  };
  std::unordered_map<std::uint64_t, Seen> cells_;
};

struct SurfaceScore {
  /// Median distance from a lattice of points on the mesh to the room's surface, weighted by area, m.
  double error_median_m = 0.0;
  /// 95th percentile of these distances, weighted by area, m.
  double error_p95_m = 0.0;
  /// Fraction of the mesh's area within kSurfaceFound_m of the room's surface.
  double precision = 0.0;
  /// Fraction of the points `seen` within kSurfaceFound_m of a lattice point of the mesh.
  double cover = 0.0;
};

/// Compares a mesh with the true surface. All results are 0 for a mesh without triangles.
/// @param T_room_map  pose of the mesh's world frame in the room's frame
/// @param seen        result of SeenSurface::points()
/// @param spacing_m   max distance between neighbouring lattice points, > 0 and well below kSurfaceFound_m
SurfaceScore score_surface(const Mesh& mesh, const Eigen::Isometry3d& T_room_map, const Room& room,
                           const std::vector<Eigen::Vector3d>& seen, double spacing_m);

}  // namespace roomradar
