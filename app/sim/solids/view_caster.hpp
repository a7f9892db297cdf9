// view_caster.hpp: casts rays from one camera at solids, fast enough for one ray per pixel.
#pragma once
#include <span>
#include <vector>

#include "app/sim/solids/solid.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PixelHit {
  /// Depth along the optical axis; 0 if nothing was hit.
  double depth_m = 0.0;
  /// Index of the solid hit; -1 if nothing was hit.
  int solid = -1;
};

/// prepare() assigns the solids to image tiles once per frame. A ray then tests only the solids of its tile,
/// sorted by their min depth in the tile, until no other solid can be nearer. The tiles extend beyond the
/// image. A ray through a point outside the tiles tests all solids in front of the camera.
class ViewCaster {
 public:
  /// Assigns the solids to tiles. Ignores solids behind the camera. Reuses memory of earlier frames.
  void prepare(std::span<const Solid> solids, const Intrinsics& camera,
               const Eigen::Isometry3d& T_world_camera);

  /// Returns the first surface on the ray through image point (u, v).
  [[nodiscard]] PixelHit cast(double u_px, double v_px) const;
  /// Returns the depth at which the ray enters one solid, ignoring all others. Returns 0 if the ray misses
  /// the solid.
  [[nodiscard]] double depth_of(int solid, double u_px, double v_px) const;
  /// Returns true if the ray enters any solid at a depth below depth_m.
  [[nodiscard]] bool is_blocked(double u_px, double v_px, double depth_m) const;
  /// Returns the point at depth_m on the ray through (u, v), in the frame of a solid, m.
  [[nodiscard]] Eigen::Vector3d local_point(int solid, double u_px, double v_px, double depth_m) const;

 private:
  struct Prepared {
    Solid solid;
    Eigen::Matrix3d R_solid_camera;
    /// Camera centre in the solid's frame, m.
    Eigen::Vector3d camera_solid;
    /// Range of columns of tiles in which the solid may appear.
    int column_begin, column_end;
    /// Range of rows of tiles in which the solid may appear.
    int row_begin, row_end;
  };
  struct Candidate {
    int solid;
    /// Lower bound of the depths at which the tile's rays enter the solid.
    double nearest_m;
  };
  /// Returns a lower bound of the depths at which a tile's rays enter a solid; infinity if none does.
  [[nodiscard]] double nearest_in_tile_m(const Prepared& prepared, int column, int row) const;
  [[nodiscard]] double entry(int solid, double x, double y) const;
  [[nodiscard]] std::span<const Candidate> candidates(double u_px, double v_px) const;

  Intrinsics camera_;
  int columns_ = 0;
  int rows_ = 0;
  /// One entry per solid, in the order given.
  std::vector<Prepared> prepared_;
  /// All solids in front of the camera, nearest first.
  std::vector<Candidate> nearest_first_;
  /// Tiles, row by row: each tile's solids, nearest first.
  std::vector<std::vector<Candidate>> tiles_;
};

}  // namespace roomradar
