// view_caster.hpp: exact depth of a set of solids at any point of an image, fast enough for every pixel.
#pragma once
#include <span>
#include <vector>

#include "app/sim/solids/solid.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PixelHit {
  double depth_m = 0.0;  ///< along the optical axis; 0 = nothing is there
  int solid = -1;        ///< index of the solid hit
};

/// Sorts solids into tiles of the image once a frame; a ray then tries only those that its tile may show,
/// nearest first. Points of the image may lie outside of it: all solids before the camera are tried there.
class ViewCaster {
 public:
  /// Keeps its allocations between frames. Solids behind the camera are dropped.
  void prepare(std::span<const Solid> solids, const Intrinsics& camera,
               const Eigen::Isometry3d& T_world_camera);

  /// The first surface along the ray through image point (u, v).
  [[nodiscard]] PixelHit cast(double u_px, double v_px) const;
  /// Depth of one solid alone along that ray; 0 if it misses.
  [[nodiscard]] double depth_of(int solid, double u_px, double v_px) const;
  /// Whether anything lies nearer than depth_m along that ray.
  [[nodiscard]] bool is_blocked(double u_px, double v_px, double depth_m) const;
  /// Point on the ray through (u, v) at depth_m, in the frame of one solid.
  [[nodiscard]] Eigen::Vector3d local_point(int solid, double u_px, double v_px, double depth_m) const;

 private:
  struct Prepared {
    Solid solid;
    Eigen::Matrix3d R_solid_camera;
    Eigen::Vector3d camera_solid;  ///< the camera's centre in the solid's frame
    double nearest_m;              ///< no point of the solid has a smaller depth
    int column_begin, column_end;  ///< tiles that it may show in
    int row_begin, row_end;
  };
  [[nodiscard]] double entry(const Prepared& prepared, double x, double y) const;
  [[nodiscard]] std::span<const int> candidates(double u_px, double v_px) const;

  Intrinsics camera_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Prepared> prepared_;       ///< one a solid, in the order given
  std::vector<int> nearest_first_;       ///< all solids before the camera
  std::vector<std::vector<int>> tiles_;  ///< row by row; the solids of each, nearest first
};

}  // namespace roomradar
