// floor_plan.cpp: clips triangles to slabs of height and projects them along z.
#include "app/media/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/media/canvas.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

constexpr double kMaxScale_px_per_m = 100.0;
constexpr int kPlanMargin_px = 30, kTitle_px = 40, kScaleBar_px = 60;
constexpr double kFloorReach_m = 0.1;     // heights of floor
constexpr double kCut_m[2] = {0.3, 1.8};  // heights of walls, above the floor
constexpr double kCosLevel = 0.9;         // of a surface's tilt against the horizontal
constexpr Rgb kPaperWhite{255, 255, 255}, kPlanFloor{222, 228, 235}, kTop{150, 156, 165}, kWall{35, 40, 48},
    kPlanText{40, 44, 52};

struct Layout {
  Eigen::AlignedBox2d extent_m;
  double px_per_m = 1.0;
  int width_px = 0, height_px = 0;  ///< of one floor's drawing

  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector3d& p_world) const {
    return {(p_world.x() - extent_m.min().x()) * px_per_m, (extent_m.max().y() - p_world.y()) * px_per_m};
  }
};

Layout layout_of(const Mesh& mesh, std::size_t floors, int most_px) {
  Layout layout;
  for (const Eigen::Vector3f& v : mesh.vertices)
    layout.extent_m.extend((mesh.origin + v.cast<double>()).head<2>());
  const Eigen::Vector2d size_m = layout.extent_m.sizes().cwiseMax(0.1);
  const double count = static_cast<double>(floors);
  const double for_width = (most_px - (count + 1.0) * kPlanMargin_px - 2.0 * count) / (count * size_m.x());
  const double for_height = (most_px - 2.0 * kPlanMargin_px - kTitle_px - kScaleBar_px - 2.0) / size_m.y();
  layout.px_per_m = std::clamp(std::min(for_width, for_height), 0.1, kMaxScale_px_per_m);
  layout.width_px = static_cast<int>(std::ceil(size_m.x() * layout.px_per_m)) + 1;
  layout.height_px = static_cast<int>(std::ceil(size_m.y() * layout.px_per_m)) + 1;
  return layout;
}

/// Clips a convex polygon to the points with sign * (z - height) >= 0. Source: Sutherland and Hodgman 1974.
std::vector<Eigen::Vector3d> clipped(const std::vector<Eigen::Vector3d>& polygon, double height_m,
                                     double sign) {
  std::vector<Eigen::Vector3d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double above_p = sign * (p.z() - height_m), above_q = sign * (q.z() - height_m);
    if (above_p >= 0.0) inside.push_back(p);
    if ((above_p >= 0.0) != (above_q >= 0.0)) inside.push_back(p + above_p / (above_p - above_q) * (q - p));
  }
  return inside;
}

struct FloorMasks {
  MaskImage floor, tops, walls;
};

void draw_line(MaskImage& mask, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const int steps = 1 + static_cast<int>(std::ceil(2.0 * (b - a).norm()));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = a + static_cast<double>(i) / steps * (b - a);
    const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
    if (mask.contains(x, y)) mask.at(x, y) = 255;
  }
}

/// Fills a convex polygon and draws its outline: a wall's polygon has no area from above.
void draw_polygon(const std::vector<Eigen::Vector3d>& polygon, const Layout& layout, MaskImage& mask) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& p_world : polygon) corners.push_back(layout.at(p_world));
  for (std::size_t i = 0; i < corners.size(); ++i)
    draw_line(mask, corners[i], corners[(i + 1) % corners.size()]);
  for (std::size_t i = 2; i < corners.size(); ++i)
    fill_triangle(mask, corners[0], corners[i - 1], corners[i]);
}

FloorMasks masks_of(const Mesh& mesh, double floor_m, const Layout& layout) {
  const MaskImage empty(layout.width_px, layout.height_px, 0);
  FloorMasks masks{empty, empty, empty};
  for (const Triangle& t : mesh.triangles) {
    std::vector<Eigen::Vector3d> triangle;
    for (const std::uint32_t v : t) triangle.emplace_back(mesh.origin + mesh.vertices[v].cast<double>());
    const Eigen::Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    const bool is_level = normal.z() >= kCosLevel * normal.norm();
    const auto slab = [&](double low_m, double high_m, MaskImage& mask) {
      const auto part = clipped(clipped(triangle, floor_m + low_m, 1.0), floor_m + high_m, -1.0);
      if (!part.empty()) draw_polygon(part, layout, mask);
    };
    if (is_level) slab(-kFloorReach_m, kFloorReach_m, masks.floor);
    slab(kCut_m[0], kCut_m[1], is_level ? masks.tops : masks.walls);
  }
  return masks;
}

/// Draws a bar of 1, 2 or 5 times a power of ten metres, about a fifth of the width.
void draw_scale_bar(const Layout& layout, int y, ColourImage& picture) {
  double length_m = 0.1;
  constexpr std::array<double, 3> kNext = {2.0, 2.5, 2.0};
  for (std::size_t i = 0; length_m * kNext[i % 3] * layout.px_per_m <= std::max(60.0, layout.width_px / 4.0);
       ++i)
    length_m *= kNext[i % 3];
  const double left = kPlanMargin_px, right = kPlanMargin_px + length_m * layout.px_per_m;
  draw_line(picture, {left, y}, {right, y}, kPlanText, 2);
  for (const double x : {left, right}) draw_line(picture, {x, y - 6.0}, {x, y + 6.0}, kPlanText, 2);
  std::array<char, 32> text{};
  format_classic(text.data(), text.size(), "%g m", length_m);
  draw_text(picture, text.data(), static_cast<int>(right) + 12, y + 6, 0.6, kPlanText);
}

}  // namespace

ColourImage draw_floor_plans(const Mesh& mesh_world, std::span<const double> floor_heights_m, int most_px) {
  if (mesh_world.triangles.empty() || floor_heights_m.empty()) return {};
  const Layout layout = layout_of(mesh_world, floor_heights_m.size(), most_px);
  const int count = static_cast<int>(floor_heights_m.size());
  ColourImage picture(std::max(count * (layout.width_px + kPlanMargin_px) + kPlanMargin_px, 300),
                      layout.height_px + 2 * kPlanMargin_px + kTitle_px + kScaleBar_px, kPaperWhite);
  for (int i = 0; i < count; ++i) {
    const double floor_m = floor_heights_m[static_cast<std::size_t>(i)];
    const FloorMasks masks = masks_of(mesh_world, floor_m, layout);
    ColourImage drawing(layout.width_px, layout.height_px, kPaperWhite);
    for (const auto& [mask, colour] :
         {std::pair(&masks.floor, kPlanFloor), std::pair(&masks.tops, kTop), std::pair(&masks.walls, kWall)})
      for (std::size_t p = 0; p < drawing.pixels.size(); ++p)
        if (mask->pixels[p] != 0) drawing.pixels[p] = colour;
    const int x = kPlanMargin_px + i * (layout.width_px + kPlanMargin_px);
    std::array<char, 48> title{};
    format_classic(title.data(), title.size(), "floor at %.2f m", rounded(floor_m, 2));
    draw_text(picture, title.data(), x, kPlanMargin_px + 16, 0.7, kPlanText);
    paste(drawing, x, kPlanMargin_px + kTitle_px, picture);
  }
  draw_scale_bar(layout, picture.height - kScaleBar_px / 2, picture);
  return picture;
}

}  // namespace roomradar
