// unknown_support.cpp: casts rays from candidate positions to the point of support.
#include "app/objects/unknown_support.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mapping/types/system/classic_locale.hpp"
#include "radar/exact/ray_hit.hpp"

namespace roomradar {
namespace {

constexpr double kClear_m = 0.06;  // the border itself, and the surface that the object stands on

bool is_free(const Eigen::Vector3d& from_world, const Eigen::Vector3d& to_world,
             std::span<const SceneTree> scene) {
  const Eigen::Vector3d way = to_world - from_world;
  const Ray ray{from_world, way.normalized()};
  for (const SceneTree& surface : scene) {
    if (surface.kind != SurfaceKind::kStatic && surface.kind != SurfaceKind::kUnknownFrontier) continue;
    if (hit_mesh(surface.instance, ray, way.norm() - kClear_m)) return false;
  }
  return true;
}

}  // namespace

std::string_view support_words(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kStatic:
      return " on the room's surface";
    case SurfaceKind::kDynamic:
      return " on something that moved";
    case SurfaceKind::kObject:
      return " on another object";
    case SurfaceKind::kUnknownFrontier:
      return " on the frontier of unknown space";
    case SurfaceKind::kInferredBack:
      return " on the inferred back of something that moved";
    case SurfaceKind::kNothing:
      break;
  }
  return "";
}

bool rests_on_unknown(const VirtualObject& object) {
  return object.in_room && object.body.asleep && object.body.rests_on == SurfaceKind::kUnknownFrontier;
}

Eigen::Vector3d support_point_world(const VirtualObject& object) {
  Eigen::Vector3d point = middle_world(object);
  point.z() = object.body.T_world_object.translation().z() + lowest_m(object);
  return point;
}

std::optional<Eigen::Vector3d> viewpoint_of_support(const VirtualObject& object,
                                                    std::span<const SceneTree> scene,
                                                    const Eigen::Vector3d& towards_world) {
  constexpr int kDirections = 24;
  const Eigen::Vector3d support = support_point_world(object);
  const double start_rad = std::atan2(towards_world.y() - support.y(), towards_world.x() - support.x());
  for (const double elevation_deg : {60.0, 45.0, 30.0, 15.0})
    for (const double distance_m : {1.5, 1.0, 0.6})
      for (int i = 0; i < kDirections; ++i) {
        // 0, +1, -1, +2, -2, ... steps from the start
        const int step = (i + 1) / 2 * (i % 2 == 0 ? -1 : 1);
        const double azimuth_rad = start_rad + step * 2.0 * std::numbers::pi / kDirections;
        const double elevation_rad = elevation_deg * std::numbers::pi / 180.0;
        const Eigen::Vector3d from =
            support + distance_m * Eigen::Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                                   std::cos(elevation_rad) * std::sin(azimuth_rad),
                                                   std::sin(elevation_rad));
        if (is_free(from, support, scene)) return from;
      }
  return std::nullopt;
}

std::string unknown_support_text(const VirtualObject& object, std::span<const SceneTree> scene,
                                 const Eigen::Vector3d& towards_world) {
  const Eigen::Vector3d p = support_point_world(object);
  std::array<char, 160> text{};
  const std::optional<Eigen::Vector3d> from = viewpoint_of_support(object, scene, towards_world);
  if (from)
    format_classic(
        text.data(), text.size(),
        " rests on the frontier of unknown space at %.2f %.2f %.2f m; to make that space known, scan "
        "it from about %.1f %.1f %.1f m",
        p.x(), p.y(), p.z(), from->x(), from->y(), from->z());
  else
    format_classic(
        text.data(), text.size(),
        " rests on the frontier of unknown space at %.2f %.2f %.2f m, which is hidden from all sides", p.x(),
        p.y(), p.z());
  return text.data();
}

}  // namespace roomradar
