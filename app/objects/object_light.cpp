// object_light.cpp: casts rays to find the light that the room's surfaces occlude at objects and at surface
// points.
#include "app/objects/object_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radar/exact/ray_hit.hpp"
#include "radar/geometry/tree_pairs.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// Returns the fraction of a lamp's light that passes, from the distance of the first surface.
float lamp_fraction(const TreeInstance& room, const Vector3d& p_world, const Vector3d& to_lamp) {
  constexpr double kTakes_m = 0.8, kBehind_m = 1.3;
  const auto hit = hit_mesh(room, {p_world, to_lamp}, kBehind_m);
  return hit ? static_cast<float>(std::clamp((hit->distance_m - kTakes_m) / (kBehind_m - kTakes_m), 0.0, 1.0))
             : 1.0F;
}

/// Returns the open fraction of the half space above a point, cosine weighted.
double open_fraction(const TreeInstance& room, const Vector3d& p_world, const Vector3d& up, double reach_m) {
  constexpr int kRays = 16;
  constexpr double kGoldenAngle = 2.39996323;
  const Vector3d u = up.unitOrthogonal(), v = up.cross(u);
  double open = 0.0;
  for (int i = 0; i < kRays; ++i) {
    const double out2 = (i + 0.5) / kRays, out = std::sqrt(out2), angle = kGoldenAngle * i;
    const Vector3d direction = out * (std::cos(angle) * u + std::sin(angle) * v) + std::sqrt(1.0 - out2) * up;
    const auto hit = hit_mesh(room, {p_world, direction}, reach_m);
    open += hit ? hit->distance_m / reach_m : 1.0;
  }
  return open / kRays;
}

}  // namespace

LightReach light_reach(const TreeInstance& room, const Vector3d& middle_world, double radius_m) {
  LightReach reach;
  if (!is_usable(room) || !middle_world.allFinite() || !std::isfinite(radius_m)) return reach;
  constexpr double kSkyReach_m = 1.0;
  constexpr double kFromUpperHalf = 0.6;  // fraction of the ambient light
  static const std::array<Vector3d, 4> corners{Vector3d(1, 1, 1), {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  for (std::size_t i = 0; i < kLampDirections; ++i) {
    float sum = 0.0F;
    for (const Vector3d& corner : corners)
      sum += lamp_fraction(room, middle_world + 0.5 * radius_m * corner.normalized(),
                           lamp_directions()[i].cast<double>());
    reach.lamps[i] = sum / static_cast<float>(corners.size());
  }
  const double open = open_fraction(room, middle_world, Vector3d::UnitZ(), kSkyReach_m);
  reach.ambient = static_cast<float>(1.0 - kFromUpperHalf * (1.0 - open));
  return reach;
}

LightReach surface_reach(const TreeInstance& room, const Vector3d& p_world, const Vector3d& normal_world,
                         const Vector3d& place_world) {
  LightReach reach;
  if (!is_usable(room) || !p_world.allFinite() || !normal_world.allFinite() || !place_world.allFinite())
    return reach;
  constexpr double kSkin_m = 0.02, kSkyReach_m = 0.5, kLamp_m = 3.0;
  const Vector3d start = p_world + kSkin_m * normal_world;
  for (std::size_t i = 0; i < kLampDirections; ++i) {
    const Vector3d way = place_world + kLamp_m * lamp_directions()[i].cast<double>() - start;
    reach.lamps[i] = way.dot(normal_world) > 0.0 ? lamp_fraction(room, start, way.normalized()) : 0.0F;
  }
  reach.ambient = static_cast<float>(open_fraction(room, start, normal_world, kSkyReach_m));
  return reach;
}

void ObjectReaches::update(std::span<const std::unique_ptr<VirtualObject>> objects, const TreeInstance& room,
                           double dt_s, float renewed) {
  constexpr double kMoved_m = 0.03, kAge_s = 2.0;
  entries_.resize(objects.size());
  const auto determine = [&](std::size_t i) {
    Entry& entry = *entries_[i];
    entry.middle_world = middle_world(*objects[i]);
    entry.now = light_reach(room, entry.middle_world, radius_m(*objects[i]));
    entry.age_s = 0.0;
  };
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i]->in_room) {
      entries_[i].reset();
    } else if (entries_[i]) {
      entries_[i]->age_s += dt_s;
    } else {
      entries_[i].emplace();
      determine(i);
      entries_[i]->smooth = entries_[i]->now;
    }
  }
  for (std::size_t step = 1; step <= objects.size(); ++step) {
    const std::size_t i = (last_ + step) % objects.size();
    const auto& entry = entries_[i];
    if (!entry ||
        !(entry->age_s > kAge_s || (entry->middle_world - middle_world(*objects[i])).norm() > kMoved_m))
      continue;
    determine(i);
    last_ = i;
    break;
  }
  for (auto& entry : entries_) {
    if (!entry) continue;
    entry->smooth.ambient += renewed * (entry->now.ambient - entry->smooth.ambient);
    for (std::size_t k = 0; k < kLampDirections; ++k)
      entry->smooth.lamps[k] += renewed * (entry->now.lamps[k] - entry->smooth.lamps[k]);
  }
}

}  // namespace roomradar
