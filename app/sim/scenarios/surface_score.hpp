// surface_score.hpp: accuracy and completeness of a mesh against the simulated room it was reconstructed
// from.
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

/// Max distance at which a surface counts as found.
inline constexpr double kSurfaceFound_m = 0.02;

/// The part of a room's true surface that the frames measured within 5 m: one point per cube of
/// kSurfaceFound_m.
class SeenSurface {
 public:
  /// Adds a frame of a simulated source with its truth. Pixels of moving objects are ignored.
  void add(const Frame& frame, const SimTruth& truth);

  /// Returns the points measured by at least three frames, in the room's frame.
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
  double error_median_m = 0.0;  ///< distance to the room's surface, of points spread evenly over the mesh
  double error_p95_m = 0.0;
  double precision = 0.0;  ///< fraction of the mesh within kSurfaceFound_m of the room's surface
  double cover = 0.0;      ///< fraction of the seen surface with mesh within kSurfaceFound_m
};

/// Scores a mesh; all results are 0 for a mesh without triangles.
/// @param T_room_map  pose of the mesh's world in the room's frame
/// @param seen        SeenSurface::points()
/// @param spacing_m   between sample points on the mesh, > 0 and well below kSurfaceFound_m
SurfaceScore score_surface(const Mesh& mesh, const Eigen::Isometry3d& T_room_map, const Room& room,
                           const std::vector<Eigen::Vector3d>& seen, double spacing_m);

}  // namespace roomradar
