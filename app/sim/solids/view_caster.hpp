// view_caster.hpp: ray casts solids from one camera, fast enough for every pixel.
#pragma once
#include <span>
#include <vector>

#include "app/sim/solids/solid.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PixelHit {
  double depth_m = 0.0;  ///< along the optical axis; 0 = no hit
  int solid = -1;        ///< index of the solid hit; -1 = no hit
};

/// Bins solids into image tiles once per frame; a ray then tests only the solids of its tile, nearest first.
/// A point outside the image is tested against all solids in front of the camera.
class ViewCaster {
 public:
  /// Bins the solids for this view. Drops solids behind the camera; reuses memory from earlier frames.
  void prepare(std::span<const Solid> solids, const Intrinsics& camera,
               const Eigen::Isometry3d& T_world_camera);

  /// Returns the first surface along the ray through image point (u, v).
  [[nodiscard]] PixelHit cast(double u_px, double v_px) const;
  /// Returns the depth of one solid along the ray, ignoring all others; 0 if the ray misses it.
  [[nodiscard]] double depth_of(int solid, double u_px, double v_px) const;
  /// Returns true if any solid along the ray is nearer than depth_m.
  [[nodiscard]] bool is_blocked(double u_px, double v_px, double depth_m) const;
  /// Returns the point at depth_m on the ray through (u, v), in the frame of a solid.
  [[nodiscard]] Eigen::Vector3d local_point(int solid, double u_px, double v_px, double depth_m) const;

 private:
  struct Prepared {
    Solid solid;
    Eigen::Matrix3d R_solid_camera;
    Eigen::Vector3d camera_solid;  ///< the camera's centre in the solid's frame
    double nearest_m;              ///< lower bound of the depth of the solid's points
    int column_begin, column_end;  ///< tiles that the solid may appear in
    int row_begin, row_end;
  };
  [[nodiscard]] double entry(const Prepared& prepared, double x, double y) const;
  [[nodiscard]] std::span<const int> candidates(double u_px, double v_px) const;

  Intrinsics camera_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Prepared> prepared_;       ///< one per solid, in the order given
  std::vector<int> nearest_first_;       ///< all solids in front of the camera
  std::vector<std::vector<int>> tiles_;  ///< row by row; the solids of each, nearest first
};

}  // namespace roomradar
