// object_height_map.hpp: M, a conservative height map of the object's leading surface.
#pragma once
#include <cstddef>
#include <vector>

#include "radar/geometry/column_search.hpp"

namespace roomradar {

/// Image with an upper bound of the object's height over each pixel's area, and its max pyramid. Height is
/// the coordinate along the motion (z in the frame of the motion).
///
/// The map is conservative. Every triangle is entered into all pixels that it may touch, rounding included. A
/// tree node that touches at most 2 x 2 pixels is entered as a box. The cost thus grows with the number of
/// pixels, not of triangles. Detail smaller than a pixel counts with its greatest height. A node is skipped
/// only if all its pixels already have at least the node's height.
class ObjectHeightMap {
 public:
  /// Sets the object's orientation and computes bounds(). Callers can choose a resolution from bounds(). A
  /// call of build() must follow. Has no effect if tree, rotation and margin are unchanged.
  void turn(const TurnedTree& object);
  /// Builds the map. Has no effect if neither the object's orientation nor the resolution changed.
  /// @param resolution_px  number of pixels along the longer side of the object's bounding rectangle
  ///                       perpendicular to the motion
  void build(const TurnedTree& object, int resolution_px);

  /// Returns true if the map was built from this tree, rotation and margin, at any resolution.
  [[nodiscard]] bool holds(const TurnedTree& object) const;

  /// Returns the greatest height over a rectangle perpendicular to the motion, or -infinity if no pixel
  /// intersects it.
  [[nodiscard]] float max_under(float x0_m, float x1_m, float y0_m, float y1_m) const;

  /// Returns a lower bound of the gap to a scene triangle. The bound is the minimum of the plane's height
  /// minus M over all pixels that the triangle touches. The bound is infinite if the triangle touches no
  /// pixel, and tighter than a bound from the triangle's box.
  [[nodiscard]] float least_gap_under(const FrameTriangle& scene) const;

  /// Returns the bounds of the whole object in the frame of the motion, margin included, m.
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  /// Returns the longer side of the map, perpendicular to the motion, m.
  [[nodiscard]] double side_m() const { return pixel_m_ * resolution_px_; }
  [[nodiscard]] double pixel_m() const { return pixel_m_; }

 private:
  struct Level {
    int width = 0, height = 0;
    // Index of the level's first pixel in heights_.
    std::size_t first = 0;
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
