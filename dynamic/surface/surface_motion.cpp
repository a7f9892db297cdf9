// surface_motion.cpp: registration of few points, by brute force.
#include "dynamic/surface/surface_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

namespace roomradar {
namespace {

using Vec3f = Eigen::Vector3f;

/// Coordinates relative to the centre, one array per axis.
struct Points {
  std::vector<float> x, y, z;
  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vec3f operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Returns at most `most` of the points within reach_m of the centre, evenly from their sequence.
Points near_points(std::span<const Eigen::Vector3d> points_world, const Eigen::Vector3d& centre_world,
                   double reach_m, std::size_t most) {
  std::vector<Vec3f> all;
  for (const Eigen::Vector3d& p : points_world)
    if ((p - centre_world).squaredNorm() <= reach_m * reach_m)
      all.push_back((p - centre_world).cast<float>());
  Points points;
  const std::size_t stride = (all.size() + most - 1) / std::max<std::size_t>(most, 1);
  for (std::size_t i = 0; i < all.size(); i += stride) {
    points.x.push_back(all[i].x());
    points.y.push_back(all[i].y());
    points.z.push_back(all[i].z());
  }
  return points;
}

struct Match {
  float squared_m2;
  Vec3f offset;  ///< from the point to its nearest point
};

Match nearest(const Points& points, const Vec3f& to) {
  float least = std::numeric_limits<float>::infinity();
  std::size_t at = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float x = points.x[i] - to.x(), y = points.y[i] - to.y(), z = points.z[i] - to.z();
    const float squared = x * x + y * y + z * z;
    at = squared < least ? i : at;
    least = std::min(least, squared);
  }
  return {least, points[at] - to};
}

constexpr float kFarOff_m = 0.03F;  // points farther apart are no match, and count as this far apart

/// How well a translation matches two sets of points.
struct Fit {
  Vec3f translation = Vec3f::Zero();
  float cost_m2 = std::numeric_limits<float>::infinity();  ///< mean square of the distances, both ways
  Vec3f improvement = Vec3f::Zero();                       ///< mean offset of the matches
};

/// Matches both ways, with `before` translated. Uses every stride-th point of each set.
Fit fit(const Points& before, const Points& now, const Vec3f& translation, float reach_m,
        std::size_t stride) {
  constexpr float kShorter = 0.02F;  // per metre: where an arm could as well slide along itself, it does not
  Vec3f sum = Vec3f::Zero();
  int matched = 0;
  const auto mean_cost = [&](const Points& of, auto&& match_of) {
    float total_m2 = 0.0F;
    int count = 0;
    for (std::size_t i = 0; i < of.size(); i += stride) {
      const std::optional<Match> match = match_of(of[i]);
      if (!match) continue;
      ++count;
      total_m2 += std::min(match->squared_m2, kFarOff_m * kFarOff_m);
      if (match->squared_m2 > kFarOff_m * kFarOff_m) continue;
      sum += match->offset;
      ++matched;
    }
    return count > 0 ? total_m2 / static_cast<float>(count) : kFarOff_m * kFarOff_m;
  };
  const float forward_m2 = mean_cost(now, [&](const Vec3f& p) -> std::optional<Match> {
    Match match = nearest(before, p - translation);
    match.offset = -match.offset;
    return match;
  });
  const float backward_m2 = mean_cost(before, [&](const Vec3f& p) -> std::optional<Match> {
    const Vec3f moved = p + translation;
    if (moved.norm() > 0.9F * reach_m) return std::nullopt;  // its match may be out of reach
    return nearest(now, moved);
  });
  return {translation, 0.5F * (forward_m2 + backward_m2) + kShorter * kShorter * translation.squaredNorm(),
          matched > 0 ? Vec3f(sum / static_cast<float>(matched)) : Vec3f(Vec3f::Zero())};
}

/// Returns the points of `now` that are farthest from `before`, such as fingertips that have advanced.
std::vector<Vec3f> new_points(const Points& before, const Points& now, std::size_t count) {
  std::vector<std::pair<float, std::size_t>> distances;
  for (std::size_t i = 0; i < now.size(); ++i) distances.emplace_back(nearest(before, now[i]).squared_m2, i);
  count = std::min(count, distances.size());
  std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count),
                    distances.end(), std::greater<>());
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(now[distances[i].second]);
  return points;
}

}  // namespace

void dynamic_points(const DepthImage& depth_m, const MaskImage& dynamic_mask, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_world_camera, std::vector<Eigen::Vector3d>& points_world) {
  constexpr int kMost = 20'000;
  const int pixels = depth_m.width * depth_m.height;
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / static_cast<double>(kMost)))));
  points_world.clear();
  for (int y = 0; y < depth_m.height; y += stride) {
    for (int x = 0; x < depth_m.width; x += stride) {
      const float z = depth_m.at(x, y);
      if (dynamic_mask.at(x, y) == 0 || !(z > 0.0F) || !std::isfinite(z)) continue;
      points_world.push_back(T_world_camera * back_project(camera, x, y, static_cast<double>(z)));
    }
  }
}

std::optional<Eigen::Vector3d> translation_near(std::span<const Eigen::Vector3d> before_world,
                                                std::span<const Eigen::Vector3d> now_world,
                                                const Eigen::Vector3d& centre_world, double reach_m,
                                                double farthest_m) {
  constexpr std::size_t kLeast = 12, kNow = 100, kBefore = 400, kNew = 4, kCoarse = 4;
  constexpr int kSteps = 8;
  constexpr float kSettled_m = 5e-4F, kMatched_m = 0.015F;
  const Points now = near_points(now_world, centre_world, reach_m, kNow);
  const Points before = near_points(before_world, centre_world, reach_m + farthest_m, kBefore);
  if (now.size() < kLeast || before.size() < kLeast) return std::nullopt;
  const float reach = static_cast<float>(reach_m), farthest = static_cast<float>(farthest_m);
  // A new point was some point of the last frame: one of these translations is nearly right.
  Fit best = fit(before, now, Vec3f::Zero(), reach, kCoarse);
  for (const Vec3f& point : new_points(before, now, kNew)) {
    for (std::size_t i = 0; i < before.size(); i += kCoarse) {
      const Vec3f translation = point - before[i];
      if (translation.norm() > farthest) continue;
      const Fit coarse = fit(before, now, translation, reach, kCoarse);
      if (coarse.cost_m2 < best.cost_m2) best = coarse;
    }
  }
  best = fit(before, now, best.translation, reach, 1);
  for (int i = 0; i < kSteps && best.improvement.norm() > kSettled_m; ++i) {
    Vec3f translation = best.translation + best.improvement;
    if (translation.norm() > farthest) translation *= farthest / translation.norm();
    const Fit next = fit(before, now, translation, reach, 1);
    if (!(next.cost_m2 < best.cost_m2)) break;
    best = next;
  }
  if (!(best.cost_m2 < kMatched_m * kMatched_m)) return std::nullopt;
  return best.translation.cast<double>();
}

}  // namespace roomradar
