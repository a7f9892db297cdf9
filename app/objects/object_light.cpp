// object_light.cpp: shadows of the room's surfaces on an object, by rays.
#include "app/objects/object_light.hpp"

#include <cmath>
#include <numbers>

#include "radar/exact/ray_hit.hpp"

namespace roomradar {
namespace {

constexpr double kLampReach_m = 3.0, kSkyReach_m = 1.0;

double directed_fraction(const TreeInstance& room, const Eigen::Vector3d& middle_world, double radius_m,
                         const Eigen::Vector3d& to_light_world) {
  constexpr int kAround = 6;
  const Eigen::Vector3d u = to_light_world.unitOrthogonal(), v = to_light_world.cross(u);
  int reaching = 0;
  for (int i = 0; i <= kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround, out_m = i < kAround ? 0.5 * radius_m : 0.0;
    const Ray ray{middle_world + out_m * (std::cos(angle) * u + std::sin(angle) * v), to_light_world};
    if (!hit_mesh(room, ray, kLampReach_m)) ++reaching;
  }
  return static_cast<double>(reaching) / (kAround + 1);
}

double ambient_fraction(const TreeInstance& room, const Eigen::Vector3d& middle_world) {
  constexpr int kRays = 16;
  constexpr double kGoldenAngle = 2.39996323;
  double open = 0.0;
  for (int i = 0; i < kRays; ++i) {
    const double out2 = (i + 0.5) / kRays, out = std::sqrt(out2), angle = kGoldenAngle * i;
    const Ray ray{middle_world, {out * std::cos(angle), out * std::sin(angle), std::sqrt(1.0 - out2)}};
    const auto hit = hit_mesh(room, ray, kSkyReach_m);
    open += hit ? hit->distance_m / kSkyReach_m : 1.0;
  }
  constexpr double kFromAbove = 0.6;  // fraction of the ambient light that comes from the upper half
  return 1.0 - kFromAbove * (1.0 - open / kRays);
}

}  // namespace

LightReach light_reach(const TreeInstance& room, const Eigen::Vector3d& middle_world, double radius_m,
                       const Eigen::Vector3d& to_light_world) {
  if (room.tree == nullptr || room.tree->empty() || !middle_world.allFinite() ||
      !to_light_world.allFinite() || !std::isfinite(radius_m))
    return {};
  return {static_cast<float>(directed_fraction(room, middle_world, radius_m, to_light_world)),
          static_cast<float>(ambient_fraction(room, middle_world))};
}

}  // namespace roomradar
