// level_surfaces.cpp: connected components of horizontal triangles; histogram of the heights of horizontal
// surface in the keyframes.
#include "mapping/map/level_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {
namespace {

constexpr double kCosLevel = 0.98481;   // 10 degrees
constexpr double kSameHeight_m = 0.03;  // as a table top bends in a scan
constexpr double kMinFloorShare = 0.1;  // of the largest surface: smaller and lower is a box on a ledge below
constexpr double kBelowFloor_m = 0.15;  // noise, and reflections in a shiny floor, reach less or are few
constexpr double kMostBelowFloor = 0.02;   // share of the mesh's area
constexpr double kMinFloorArea_m2 = 0.05;  // of depth pixels; each keyframe counts
constexpr double kCell_m = 0.2;            // within which a surface counts once, however often it was seen

struct LevelTriangle {
  Eigen::Vector3d middle_world;
  double area_m2 = 0.0;
  std::uint32_t vertex = 0;
};

std::vector<LevelTriangle> level_triangles(const Mesh& mesh, DisjointSets<std::uint32_t>& sets) {
  std::vector<LevelTriangle> level;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double>();
    const Eigen::Vector3d twice_area = (b - a).cross(c - a);
    const double norm = twice_area.norm();
    if (!(twice_area.z() >= kCosLevel * norm) || !(norm > 0.0)) continue;
    level.push_back({mesh.origin + (a + b + c) / 3.0, 0.5 * norm, triangle[0]});
    sets.join(triangle[0], triangle[1]);
    sets.join(triangle[0], triangle[2]);
  }
  return level;
}

/// Returns the surface of the triangles within kSameHeight_m of their most frequent height.
LevelSurface surface_of(const std::vector<const LevelTriangle*>& triangles) {
  std::map<long, double> area_at;  // by height in steps of kSameHeight_m / 2
  const auto step_of = [](double z) { return std::lround(2.0 * z / kSameHeight_m); };
  for (const LevelTriangle* t : triangles) area_at[step_of(t->middle_world.z())] += t->area_m2;
  const auto most = std::max_element(area_at.begin(), area_at.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  const double height_m = static_cast<double>(most->first) * kSameHeight_m / 2.0;
  LevelSurface surface;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const LevelTriangle* t : triangles) {
    if (std::abs(t->middle_world.z() - height_m) > kSameHeight_m) continue;
    surface.area_m2 += t->area_m2;
    sum += t->area_m2 * t->middle_world;
  }
  const Eigen::Vector3d centroid = sum / surface.area_m2;
  surface.height_m = centroid.z();
  double nearest = std::numeric_limits<double>::infinity();
  for (const LevelTriangle* t : triangles) {
    const double distance = (t->middle_world - centroid).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    surface.middle_world = t->middle_world;
  }
  return surface;
}

/// Returns the share of the mesh's area that is lower than a height.
double share_below(const Mesh& mesh, double height_m) {
  double below_m2 = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const float z_m = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).z() / 3.0F;
    if (mesh.origin.z() + static_cast<double>(z_m) < height_m) below_m2 += triangle_area_m2(mesh, t);
  }
  return below_m2 > 0.0 ? below_m2 / surface_area_m2(mesh) : 0.0;
}

/// Area of level depth pixels in a cell of kCell_m, by the cell's position on a level plane.
using AreaOfCells = std::map<std::pair<long, long>, double>;

/// Adds the area of a keyframe's level pixels to a histogram over their heights, in steps of 1 cm.
void add_level_pixels(const MapKeyframe& keyframe, const Eigen::Vector3d& up_world,
                      std::map<long, AreaOfCells>& level_at) {
  constexpr int kStep_px = 4;          // noise of normals from nearer pixels exceeds 10 degrees
  constexpr double kFarthest_m = 4.0;  // a Kinect's error grows to 2 cm there
  const Eigen::Vector3d along = up_world.unitOrthogonal(), across = up_world.cross(along);
  const Image<std::uint16_t>& depth_mm = keyframe.preview_depth_mm;
  const Intrinsics& camera = keyframe.preview_camera;
  const auto point = [&](int x, int y) -> std::optional<Eigen::Vector3d> {
    const double depth_m = 1e-3 * depth_mm.at(x, y);
    if (!(depth_m > 0.0) || depth_m > kFarthest_m) return std::nullopt;
    return keyframe.T_world_camera * back_project(camera, x, y, depth_m);
  };
  for (int y = 0; y + kStep_px < depth_mm.height; y += kStep_px)
    for (int x = 0; x + kStep_px < depth_mm.width; x += kStep_px) {
      const auto here = point(x, y), right = point(x + kStep_px, y), below = point(x, y + kStep_px);
      if (!here || !right || !below) continue;
      const Eigen::Vector3d area = (*below - *here).cross(*right - *here);  // towards the camera
      const double area_m2 = area.norm();
      if (!(area.dot(up_world) > kCosLevel * area_m2) || area_m2 > 0.02) continue;
      const std::pair cell(std::lround(here->dot(along) / kCell_m), std::lround(here->dot(across) / kCell_m));
      level_at[std::lround(100.0 * here->dot(up_world))][cell] += area_m2;
    }
}

/// Level surface within 2 cm of a height.
struct NearHeight {
  double measured_m2 = 0.0;  ///< area of depth pixels, each keyframe counts
  double surface_m2 = 0.0;   ///< the same, at most the area of the cells in which they are
  double height_m = 0.0;     ///< mean height of the depth pixels
};

NearHeight near_height(const std::map<long, AreaOfCells>& level_at, long step) {
  NearHeight near;
  AreaOfCells cells;
  double moment = 0.0;
  for (auto at = level_at.lower_bound(step - 2); at != level_at.end() && at->first <= step + 2; ++at)
    for (const auto& [cell, area_m2] : at->second) {
      cells[cell] += area_m2;
      near.measured_m2 += area_m2;
      moment += 0.01 * static_cast<double>(at->first) * area_m2;
    }
  for (const auto& [cell, area_m2] : cells) near.surface_m2 += std::min(area_m2, kCell_m * kCell_m);
  near.height_m = moment / near.measured_m2;
  return near;
}

}  // namespace

std::vector<LevelSurface> level_surfaces(const Mesh& mesh_world, double min_area_m2) {
  DisjointSets<std::uint32_t> sets(static_cast<std::uint32_t>(mesh_world.vertices.size()));
  const std::vector<LevelTriangle> level = level_triangles(mesh_world, sets);
  std::map<std::uint32_t, std::vector<const LevelTriangle*>> parts;
  for (const LevelTriangle& triangle : level) parts[sets.find(triangle.vertex)].push_back(&triangle);
  std::vector<LevelSurface> surfaces;
  for (const auto& [root, triangles] : parts) {
    const LevelSurface surface = surface_of(triangles);
    if (surface.area_m2 >= min_area_m2) surfaces.push_back(surface);
  }
  std::stable_sort(surfaces.begin(), surfaces.end(),
                   [](const auto& a, const auto& b) { return a.area_m2 > b.area_m2; });
  return surfaces;
}

std::vector<bool> floor_among(std::span<const LevelSurface> surfaces, const Mesh& mesh_world) {
  std::vector<bool> is_floor(surfaces.size(), false);
  double largest_m2 = 0.0, lowest_m = std::numeric_limits<double>::infinity();
  for (const LevelSurface& surface : surfaces) largest_m2 = std::max(largest_m2, surface.area_m2);
  for (const LevelSurface& surface : surfaces)
    if (surface.area_m2 >= kMinFloorShare * largest_m2) lowest_m = std::min(lowest_m, surface.height_m);
  if (share_below(mesh_world, lowest_m - kBelowFloor_m) >= kMostBelowFloor) return is_floor;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    is_floor[i] = std::abs(surfaces[i].height_m - lowest_m) <= kSameHeight_m;
  return is_floor;
}

std::optional<double> floor_height_m(const KeyframeDatabase& keyframe_database,
                                     const Eigen::Vector3d& up_world) {
  std::map<long, AreaOfCells> level_at;
  for (const MapKeyframe& keyframe : keyframe_database.keyframes)
    add_level_pixels(keyframe, up_world, level_at);
  double most_m2 = 0.0, most_measured_m2 = 0.0;
  for (const auto& [step, cells] : level_at) {
    const NearHeight near = near_height(level_at, step);
    most_m2 = std::max(most_m2, near.surface_m2);
    most_measured_m2 = std::max(most_measured_m2, near.measured_m2);
  }
  if (most_measured_m2 < kMinFloorArea_m2) return std::nullopt;
  // The lowest local maximum of sufficient area.
  for (const auto& [step, cells] : level_at) {
    NearHeight best = near_height(level_at, step);
    if (best.surface_m2 < kMinFloorShare * most_m2) continue;
    for (long other = step + 1; other <= step + 5; ++other) {
      if (!level_at.contains(other)) continue;
      const NearHeight near = near_height(level_at, other);
      if (near.measured_m2 > best.measured_m2) best = near;
    }
    return best.height_m;
  }
  return std::nullopt;
}

}  // namespace roomradar
