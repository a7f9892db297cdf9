// map_picture.cpp: rasterises triangles and points with a depth buffer, without GL.
#include "app/media/map_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roomradar {
namespace {

/// World to picture: x to the right, y down, z is depth; all in pixels.
Eigen::Affine3d looking_down(const Mesh& mesh, std::span<const Change> changes, int width_px,
                             int& height_px) {
  constexpr double kFullTurn_rad = 0.6, kTilt_rad = 0.9;  // about the vertical; from the horizontal
  Eigen::Matrix3d R;
  R.row(0) << std::cos(kFullTurn_rad), std::sin(kFullTurn_rad), 0.0;
  const Eigen::Vector3d ahead(-std::sin(kFullTurn_rad), std::cos(kFullTurn_rad), 0.0);
  R.row(2) = std::cos(kTilt_rad) * ahead - std::sin(kTilt_rad) * Eigen::Vector3d::UnitZ();
  R.row(1) = R.row(2).cross(R.row(0));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(R * (mesh.origin + vertex.cast<double>()));
  for (const Change& change : changes)
    for (const Eigen::Vector3d& p_world : change.surface_world) box.extend(R * p_world);
  constexpr double kMargin_px = 20.0;
  // Fits the width, but limits the height of a narrow room's picture to four times the width.
  const double scale = std::min((width_px - 2.0 * kMargin_px) / std::max(box.sizes().x(), 1e-3),
                                (4.0 * width_px - 2.0 * kMargin_px) / std::max(box.sizes().y(), 1e-3));
  height_px = static_cast<int>(box.sizes().y() * scale + 2.0 * kMargin_px);
  return Eigen::Translation3d(Eigen::Vector3d::Constant(kMargin_px)) * Eigen::Scaling(scale) *
         Eigen::Translation3d(-box.min()) * Eigen::Affine3d(R);
}

struct Canvas {
  ColourImage picture;
  Image<float> nearest_px;

  void put(int x, int y, double z, Rgb colour) {
    if (!picture.contains(x, y) || static_cast<float>(z) >= nearest_px.at(x, y)) return;
    nearest_px.at(x, y) = static_cast<float>(z);
    picture.at(x, y) = colour;
  }
};

void draw_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, Rgb colour,
                   Canvas& canvas) {
  const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  if (area >= 0.0) return;  // back face: y points down
  const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const int right = std::min(canvas.picture.width - 1, static_cast<int>(high.x()));
  const int bottom = std::min(canvas.picture.height - 1, static_cast<int>(high.y()));
  for (int y = std::max(0, static_cast<int>(std::ceil(low.y()))); y <= bottom; ++y)
    for (int x = std::max(0, static_cast<int>(std::ceil(low.x()))); x <= right; ++x) {
      const double u = ((x - a.x()) * (c - a).y() - (y - a.y()) * (c - a).x()) / area;
      const double v = ((b - a).x() * (y - a.y()) - (b - a).y() * (x - a.x())) / area;
      if (u >= 0.0 && v >= 0.0 && u + v <= 1.0)
        canvas.put(x, y, a.z() + u * (b - a).z() + v * (c - a).z(), colour);
    }
}

/// Returns the colour paled half-way to white, and darker the less the surface faces the viewer.
Rgb paled(Rgb colour, double facing) {
  const auto pale = [&](std::uint8_t of) {
    return static_cast<std::uint8_t>((0.5 + 0.5 * facing) * (0.6 * of + 100.0));
  };
  return {pale(colour.r), pale(colour.g), pale(colour.b)};
}

}  // namespace

ColourImage draw_changes(const Mesh& mesh, std::span<const Change> changes, int width_px, Rgb ground) {
  if (mesh.triangles.empty()) return {};
  int height_px = 0;
  const Eigen::Affine3d to_picture = looking_down(mesh, changes, width_px, height_px);
  Canvas canvas{ColourImage(width_px, height_px, ground),
                Image<float>(width_px, height_px, 1e9F)};
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    corners.push_back(to_picture * (mesh.origin + vertex.cast<double>()));
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d &a = corners[triangle[0]], &b = corners[triangle[1]], &c = corners[triangle[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    const Rgb colour = mesh.colours.empty() ? Rgb{180, 180, 180} : mesh.colours[triangle[0]];
    draw_triangle(a, b, c, paled(colour, std::abs(normal.z())), canvas);
  }
  constexpr double kAhead_px = 4.0;  // so that a change is not hidden by its own surface
  for (const Change& change : changes) {
    const Rgb colour = change.kind == ChangeKind::kAppeared ? Rgb{20, 160, 60} : Rgb{210, 40, 40};
    for (const Eigen::Vector3d& p_world : change.surface_world) {
      const Eigen::Vector3d p = to_picture * p_world;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          canvas.put(static_cast<int>(p.x()) + dx, static_cast<int>(p.y()) + dy, p.z() - kAhead_px, colour);
    }
  }
  return canvas.picture;
}

}  // namespace roomradar
