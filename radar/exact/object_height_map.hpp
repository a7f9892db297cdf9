// object_height_map.hpp: M, a conservative height map of the object's leading surface.
#pragma once
#include <cstddef>
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Upper bound of an object's height (along the motion) over the area of each pixel, with a max pyramid
/// above.
///
/// Conservative: every triangle is entered into all pixels that its box or its plane touches, rounding
/// included. A node no larger than a pixel is entered as its box, so the work grows with the pixels and not
/// with the triangles. Detail smaller than a pixel thus counts with its greatest height. A node is skipped
/// only if all its pixels already have at least its height.
class ObjectHeightMap {
 public:
  /// Computes bounds(), from which callers can choose a resolution; build() must follow. No effect if tree,
  /// rotation and margin are unchanged.
  void turn(const TurnedTree& object);
  /// Builds the map; no effect if the resolution is unchanged, too.
  void build(const TurnedTree& object, int resolution_px);

  /// Returns true if the map is of this tree, rotation and margin, at any resolution.
  [[nodiscard]] bool holds(const TurnedTree& object) const;

  /// Returns the greatest height over a rectangle, -infinity if no pixel is under it.
  [[nodiscard]] float max_under(float x0_m, float x1_m, float y0_m, float y1_m) const;

  /// Returns a lower bound of the gap to a scene triangle: the minimum, over the pixels that it touches, of
  /// its plane's height minus M. Infinite if it touches none. Tighter than the bound from the triangle's box.
  [[nodiscard]] float least_gap_under(const FrameTriangle& scene) const;

  /// Bounds of the whole object in the frame, margin included, m.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  /// Longer side across the motion, m.
  [[nodiscard]] double side_m() const { return pixel_m_ * resolution_px_; }
  [[nodiscard]] double pixel_m() const { return pixel_m_; }

 private:
  struct Level {
    int width = 0, height = 0;
    std::size_t first = 0;  // index in heights_
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

}  // namespace roomradar
