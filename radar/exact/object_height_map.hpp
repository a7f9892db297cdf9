// front_map.hpp: M, the object's leading surface in pixels, from above: what may stand out there at most.
#pragma once
#include <cstddef>
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Greatest height (along the motion) of an object over the area of each pixel, never less than the truth,
/// and the greatest over ever larger squares of pixels.
///
/// It holds because every triangle is entered into all pixels that its box or its plane touches, rounding
/// counted in, or is under a box that is; a node no larger than a pixel is entered as its box, so that the
/// work grows with the pixels and not with the triangles (whatever detail there is below a pixel counts with
/// its height); and what is passed over is not higher than what every one of its pixels holds already.
class FrontMap {
 public:
  /// Finds bounds(), which may say how many pixels are worth it; the map is to be built after this. Does
  /// nothing if the tree, the turn and the margin are those of the last time.
  void turn(const TurnedTree& object);
  /// Does nothing if the size, too, is that of the last time.
  void build(const TurnedTree& object, int resolution_px);

  /// Whether this is the map of this tree, turned so, with this margin, at whatever size.
  [[nodiscard]] bool holds(const TurnedTree& object) const;

  /// Greatest height under a rectangle, -infinity where no pixel is.
  [[nodiscard]] float max_under(float x0_m, float x1_m, float y0_m, float y1_m) const;

  /// How near a triangle of the scene can be: the least, over the pixels that it touches, of its plane's
  /// height there less M. Infinite where it touches none. Never more than the truth; finer than what its box
  /// says.
  [[nodiscard]] float least_gap_under(const FrameTriangle& scene) const;

  /// Of the whole object in the frame, the margin included, m.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  /// Longer side across the motion, m.
  [[nodiscard]] double side_m() const { return pixel_m_ * resolution_px_; }
  [[nodiscard]] double pixel_m() const { return pixel_m_; }

 private:
  struct Level {
    int width = 0, height = 0;
    std::size_t first = 0;  // in heights_
  };
  std::uint64_t revision_ = 0;
  Eigen::Matrix3d R_frame_mesh_ = Eigen::Matrix3d::Zero();
  double margin_m_ = 0.0;
  int resolution_px_ = 0;

  Eigen::AlignedBox3d bounds_;
  double pixel_m_ = 0.0;
  float x0_ = 0.0F, y0_ = 0.0F, per_m_ = 0.0F;
  std::vector<Level> levels_;
  std::vector<float> heights_;
  std::vector<PendingNode> pending_;

  void enter_tree(const TurnedTree& object);
  void build_levels();
  void enter_box(int x0, int x1, int y0, int y1, float height);
  void enter_triangle(const TurnedTree& object, std::uint32_t triangle);
  [[nodiscard]] bool is_under(int x0, int x1, int y0, int y1, float height) const;
};

/// Bounds of the tree's triangles in the turned frame, rounding and margin counted in, no more than
/// tolerance_m too large: one search a side.
Eigen::AlignedBox3d turned_bounds(const TurnedTree& object, double tolerance_m,
                                  std::vector<PendingNode>& pending);

}  // namespace roomradar
