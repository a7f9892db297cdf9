// surface_score.hpp: how true a mesh is to the simulated room that it was made of.
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

/// Within this a surface counts as found.
inline constexpr double kSurfaceFound_m = 0.02;

/// The part of a room's true surface that the frames measured within 5 m: one point a cube of
/// kSurfaceFound_m.
class SeenSurface {
 public:
  /// A frame of a simulated source and its truth. What moves is not of the room.
  void add(const Frame& frame, const SimTruth& truth);

  /// Those that at least three frames measured; in the room.
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
  double error_median_m = 0.0;  ///< of points spread evenly over the mesh to the room's surface
  double error_p95_m = 0.0;
  double precision = 0.0;  ///< part of the mesh within kSurfaceFound_m of the surface
  double cover = 0.0;      ///< part of the seen surface that has mesh within kSurfaceFound_m
};

/// All figures are 0 for a mesh without triangles.
/// @param T_room_map  from the mesh's world to the room's
/// @param seen        SeenSurface::points()
/// @param spacing_m   of the points on the mesh, > 0 and well below kSurfaceFound_m
SurfaceScore score_surface(const Mesh& mesh, const Eigen::Isometry3d& T_room_map, const Room& room,
                           const std::vector<Eigen::Vector3d>& seen, double spacing_m);

}  // namespace roomradar
