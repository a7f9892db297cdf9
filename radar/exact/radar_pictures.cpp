// radar_pictures.cpp: draws the object's front, then the first scene ahead of it.
#include "radar/exact/radar_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radar/exact/cyber_radar.hpp"
#include "radar/exact/turned_bounds.hpp"
#include "radar/geometry/frame_along.hpp"
#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

/// Pixels in the frame of a motion, drawn into by orthographic projection along it.
struct Raster {
  PixelGrid grid;
  Eigen::Vector2d corner_m = Eigen::Vector2d::Zero();  ///< corner of the first pixel

  /// Calls put(pixel, height) for each pixel whose sample lies on the triangle.
  template <typename Put>
  void draw(const FrameTriangle& triangle, const Put& put) const {
    std::array<Eigen::Vector3d, 3> c;  // x and y in pixels from the first pixel's sample
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = triangle.corners[i];
      c[i].x() = (c[i].x() - corner_m.x()) / grid.pixel_m - kSampleX_px;
      c[i].y() = (c[i].y() - corner_m.y()) / grid.pixel_m - kSampleY_px;
    }
    const Eigen::Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]), high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    const auto first = [](double at) { return static_cast<int>(std::ceil(std::max(at, 0.0))); };
    const auto last = [](double at, int count) {
      return static_cast<int>(std::floor(std::min(at, count - 1.0)));
    };
    if (!(low.x() < grid.width_px && low.y() < grid.height_px && high.x() >= 0.0 && high.y() >= 0.0)) return;
    const int x0 = first(low.x()), x1 = last(high.x(), grid.width_px);
    const int y0 = first(low.y()), y1 = last(high.y(), grid.height_px);
    const auto area_at = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double x, double y) {
      return (a.x() - x) * (b.y() - y) - (a.y() - y) * (b.x() - x);
    };
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double w0 = area_at(c[1], c[2], x, y), w1 = area_at(c[2], c[0], x, y),
                     w2 = area_at(c[0], c[1], x, y);
        const bool is_in = (w0 >= 0.0 && w1 >= 0.0 && w2 >= 0.0) || (w0 <= 0.0 && w1 <= 0.0 && w2 <= 0.0);
        const double sum = w0 + w1 + w2;
        if (!is_in || sum == 0.0) continue;
        put(static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width_px) +
                static_cast<std::size_t>(x),
            (w0 * c[0].z() + w1 * c[1].z() + w2 * c[2].z()) / sum);
      }
    }
  }
};

RadarVolume volume_of(const RadarQuery& query, const Eigen::Matrix3d& R_frame_world,
                      const Eigen::Vector3d& origin_world, const Eigen::AlignedBox3d& bounds,
                      const Raster& raster) {
  RadarVolume volume;
  volume.x_world = R_frame_world.row(0);
  volume.y_world = R_frame_world.row(1);
  volume.u_world = R_frame_world.row(2);
  volume.origin_world =
      origin_world +
      R_frame_world.transpose() * Eigen::Vector3d(raster.corner_m.x(), raster.corner_m.y(), bounds.min().z());
  volume.pixel_m = raster.grid.pixel_m;
  volume.length_m = bounds.sizes().z();
  volume.depth_m = volume.length_m + query.distance_m;
  volume.width_px = raster.grid.width_px;
  volume.height_px = raster.grid.height_px;
  return volume;
}

/// Calls draw(triangle) for all scene in the volume that is below or ahead of the object.
template <typename Draw>
void visit_scene(SceneInFrame& scene, const ObjectHeightMap& front, const Eigen::AlignedBox3d& volume,
                 const Draw& draw) {
  const SceneBound bound{&front, static_cast<float>(volume.min().z())};
  constexpr float kNoLimit = std::numeric_limits<float>::infinity();
  std::vector<SceneItem> items;
  scene.enter(volume);
  scene.begin(bound, kNoLimit, items);
  while (!items.empty()) {
    const SceneItem item = items.back();
    items.pop_back();
    if (item.is_triangle()) {
      const FrameTriangle triangle = scene.triangle(item);
      if (triangle.normal.z() <= kEdgeOn || !is_one_sided(scene.kind(item))) draw(triangle);
    } else {
      scene.expand(item, bound, kNoLimit, items);
    }
  }
}

}  // namespace

Eigen::AlignedBox3d RadarVolume::bounds_world() const {
  Eigen::AlignedBox3d bounds(origin_world);
  const Eigen::Vector3d sides[3] = {width_px * pixel_m * x_world, height_px * pixel_m * y_world,
                                    depth_m * u_world};
  for (const Eigen::Vector3d& side : sides) {
    bounds.min() += side.cwiseMin(0.0);
    bounds.max() += side.cwiseMax(0.0);
  }
  return bounds;
}

RadarPictures radar_pictures(const RadarQuery& query, const RadarScene& scene, int resolution_px) {
  RadarPictures pictures;
  if (!is_valid(query)) return pictures;
  const TriangleTree& tree = *query.object.tree;
  TurnedTree object;
  object.tree = &tree;
  object.R_frame_mesh =
      frame_along((query.object.T_world_mesh.linear().transpose() * query.direction_world.stableNormalized())
                      .normalized());
  object.touching_m = touching_m(tree);
  const Eigen::Matrix3d R_frame_world = object.R_frame_mesh * query.object.T_world_mesh.linear().transpose();
  const Eigen::Vector3d origin_world = query.object.T_world_mesh * (tree.origin() + tree.centre());
  SceneInFrame placed;
  if (!origin_world.allFinite() || !placed.place(scene, query.own_tree, R_frame_world, origin_world))
    return pictures;

  std::vector<PendingNode> pending;
  const Eigen::AlignedBox3d bounds = turned_bounds(object, 0.0, pending);
  Raster raster;
  raster.grid = fit_pixels(bounds.sizes().x(), bounds.sizes().y(), std::clamp(resolution_px, 1, 4096));
  raster.corner_m = bounds.center().head<2>() -
                    0.5 * raster.grid.pixel_m * Eigen::Vector2d(raster.grid.width_px, raster.grid.height_px);
  pictures.volume = volume_of(query, R_frame_world, origin_world, bounds, raster);

  const auto count =
      static_cast<std::size_t>(raster.grid.width_px) * static_cast<std::size_t>(raster.grid.height_px);
  std::vector<double> front_m(count, -kInfinity<double>), gap_m(count, kInfinity<double>);
  for (std::uint32_t i = 0; i < tree.triangle_count(); ++i) {
    raster.draw(turned_corners(object, i),
                [&](std::size_t pixel, double z) { front_m[pixel] = std::max(front_m[pixel], z); });
  }
  constexpr int kCulling_px = 24;
  ObjectHeightMap front;
  front.build(object, kCulling_px);
  Eigen::AlignedBox3d volume = front.bounds();
  volume.min().z() -= object.touching_m;
  volume.max().z() += query.distance_m;
  visit_scene(placed, front, volume, [&](const FrameTriangle& triangle) {
    raster.draw(triangle, [&](std::size_t pixel, double z) {
      const double gap = z - front_m[pixel];
      const bool is_in_volume = z <= bounds.max().z() + query.distance_m;
      if (gap >= -object.touching_m && is_in_volume) gap_m[pixel] = std::min(gap_m[pixel], gap);
    });
  });

  const auto depth_m = static_cast<float>(pictures.volume.depth_m);
  const int width = raster.grid.width_px, height = raster.grid.height_px;
  pictures.range_m.resize(width, height, depth_m);
  pictures.mask_m.resize(width, height, depth_m);
  pictures.lookat_m.resize(width, height, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < count; ++i) {
    if (front_m[i] == -kInfinity<double>) continue;
    const double behind_front_m = bounds.max().z() - front_m[i];
    pictures.mask_m.pixels[i] = static_cast<float>(query.distance_m + behind_front_m);
    if (gap_m[i] == kInfinity<double>) continue;
    pictures.lookat_m.pixels[i] = static_cast<float>(gap_m[i]);
    pictures.range_m.pixels[i] = static_cast<float>(pictures.volume.length_m - behind_front_m + gap_m[i]);
  }
  return pictures;
}

}  // namespace roomradar
