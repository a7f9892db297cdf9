// free_pose.cpp: samples translations in 98 directions, shortest first.
#include "app/physics/placement/free_pose.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

/// Returns the unit directions to the points of a grid of 5 x 5 on each face of a cube, upward ones first.
std::vector<Vec3> directions() {
  constexpr int kHalf = 2;
  std::vector<Vec3> all;
  for (int z = kHalf; z >= -kHalf; --z)
    for (int y = -kHalf; y <= kHalf; ++y)
      for (int x = -kHalf; x <= kHalf; ++x)
        if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == kHalf)
          all.push_back(Vec3(x, y, z).normalized());
  std::stable_sort(all.begin(), all.end(), [](const Vec3& a, const Vec3& b) { return a.z() > b.z() + 1e-9; });
  return all;
}

Eigen::Isometry3d moved_by(const Eigen::Isometry3d& T, const Vec3& way) {
  Eigen::Isometry3d moved = T;
  moved.translation() += way;
  return moved;
}

class ExitSearch {
 public:
  ExitSearch(const TreeInstance& object, std::span<const SceneTree> surfaces, double gap_m, CyberRadar& radar)
      : object_(object), surfaces_(surfaces), gap_m_(gap_m), radar_(radar) {
    // With one-sided surfaces, the way back meets fronts only.
    for (const SceneTree& surface : surfaces)
      fronts_.push_back({surface.instance, SurfaceKind::kInferredBack});
  }

  /// Returns true if nothing crosses the object after this way, or is nearer than the gap.
  bool is_clear(const Vec3& way) {
    const TreeInstance moved{object_.tree, moved_by(object_.T_world_mesh, way)};
    const SurfaceKindMask crossed = near_features(moved, {surfaces_, {}}, gap_m_, 0, near_);
    return crossed == 0 && near_.empty();
  }
  /// Returns true if the way back from there meets the front of a surface first, or only edges.
  bool is_in_front(const Vec3& direction, double length_m) {
    const TreeInstance moved{object_.tree, moved_by(object_.T_world_mesh, length_m * direction)};
    const RadarQuery back{moved, -direction, length_m + gap_m_};
    const Contact first = radar_.query(back, {surfaces_, {}});
    if (first.status == ContactStatus::kNoTarget) return true;
    const Contact front = radar_.query(back, {fronts_, {}});
    return first.status == ContactStatus::kContact && front.status == ContactStatus::kContact &&
           first.contact_distance_m >= front.contact_distance_m - gap_m_;
  }

 private:
  const TreeInstance& object_;
  std::span<const SceneTree> surfaces_;
  double gap_m_;
  CyberRadar& radar_;
  std::vector<SceneTree> fronts_;
  std::vector<ClosestPoint> near_;
};

}  // namespace

bool is_crossed(const TreeInstance& object, std::span<const SceneTree> surfaces) {
  constexpr double kTouching_m = 1e-6;
  std::vector<ClosestPoint> unused;
  return near_features(object, {surfaces, {}}, kTouching_m, 0, unused) != 0;
}

std::optional<FreePose> nearest_free_pose(const TreeInstance& object, std::span<const SceneTree> surfaces,
                                          double gap_m, double max_m,
                                          const std::function<bool(const Eigen::Isometry3d&)>& is_allowed,
                                          CyberRadar& radar) {
  constexpr int kSteps = 20, kBisections = 5;
  const double step_m = max_m / kSteps;
  ExitSearch search(object, surfaces, gap_m, radar);
  const std::vector<Vec3> all = directions();
  std::optional<FreePose> best;
  for (int step = 1; step <= kSteps && !best; ++step) {
    for (const Vec3& direction : all) {
      double blocked_m = (step - 1) * step_m, free_m = step * step_m;
      if (!search.is_clear(free_m * direction)) continue;
      for (int i = 0; i < kBisections; ++i) {
        const double middle_m = 0.5 * (blocked_m + free_m);
        (search.is_clear(middle_m * direction) ? free_m : blocked_m) = middle_m;
      }
      const Eigen::Isometry3d T_free = moved_by(object.T_world_mesh, free_m * direction);
      if (best && best->moved_m <= free_m) continue;
      if (!search.is_in_front(direction, free_m) || (is_allowed && !is_allowed(T_free))) continue;
      best = FreePose{T_free, free_m};
    }
  }
  return best;
}

}  // namespace roomradar
