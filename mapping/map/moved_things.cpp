// moved_things.cpp: registers what vanished to what appeared, by turns about z.
#include "mapping/map/moved_things.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <set>
#include <unordered_map>

namespace roomradar {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr float kSameSurface_m = 0.03F;  // two surfaces coincide

/// Points in cubic cells, to find the nearest within one cell's edge.
class PointGrid {
 public:
  PointGrid(const Points& points, double edge_m) : points_(points), edge_m_(edge_m) {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[key(cell(points[i]))].push_back(i);
  }
  /// Returns the index of the nearest point within the edge and `most_m`; nullopt if there is none.
  [[nodiscard]] std::optional<std::size_t> nearest(const Eigen::Vector3d& p, double most_m = 1.0) const {
    std::optional<std::size_t> found;
    double least_m2 = std::min(edge_m_, most_m) * std::min(edge_m_, most_m);
    const Eigen::Vector3i middle = cell(p);
    for (int i = 0; i < 27; ++i) {
      const auto at = cells_.find(key(middle + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
      if (at == cells_.end()) continue;
      for (const std::size_t index : at->second) {
        const double m2 = (points_[index] - p).squaredNorm();
        if (m2 <= least_m2) {
          least_m2 = m2;
          found = index;
        }
      }
    }
    return found;
  }

 private:
  const Points& points_;
  double edge_m_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;

  [[nodiscard]] Eigen::Vector3i cell(const Eigen::Vector3d& p) const {
    return (p / edge_m_).array().floor().cast<int>();
  }
  static std::uint64_t key(const Eigen::Vector3i& cell) {
    constexpr std::uint64_t kMask = (1U << 21U) - 1;
    return (static_cast<std::uint64_t>(cell.x()) & kMask) << 42U |
           (static_cast<std::uint64_t>(cell.y()) & kMask) << 21U |
           (static_cast<std::uint64_t>(cell.z()) & kMask);
  }
};

/// Surface of a change, thinned, with what is needed to compare it.
struct Shape {
  /// @param shared_world  surface that belongs to it, but did not change
  Shape(const Change& change, const Points& shared_world)
      : all(change.surface_world), points(thinned(change.surface_world, shared_world)) {
    all.insert(all.end(), shared_world.begin(), shared_world.end());
    near.emplace(all, kSameSurface_m);
    far.emplace(all, 2.0 * kSameSurface_m);
    Eigen::AlignedBox3d box = change.box_world;
    for (const Eigen::Vector3d& p : points) {
      middle += p / static_cast<double>(points.size());
      box.extend(p);
    }
    size_m = box.sizes().norm();
  }
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;
  ~Shape() = default;
  Points all;
  Points points;  ///< some of them
  std::optional<PointGrid> near, far;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double size_m = 0.0;

 private:
  /// One point for each cube of 2 cm; the two kinds of surface may be sampled differently.
  static Points thinned(const Points& changed, const Points& shared) {
    constexpr double kCube_m = 0.02;
    constexpr std::size_t kMost = 1500;
    std::set<std::array<int, 3>> cubes;
    Points all, some;
    for (const Points* points : {&changed, &shared})
      for (const Eigen::Vector3d& p : *points) {
        const Eigen::Array3i cube = (p / kCube_m).array().floor().cast<int>();
        if (cubes.insert({cube.x(), cube.y(), cube.z()}).second) all.push_back(p);
      }
    const std::size_t step = all.size() / kMost + 1;
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return some;
  }
};

/// Returns the surface of both maps where the boxes of two changes overlap, every 2 cm, without the floor on
/// which a thing stands.
Points shared_surface(const Change& a, const Change& b, const SharedSurface& shared) {
  constexpr double kStep_m = 0.02, kFloor_m = 0.04, kMost = 1e6;
  Points points;
  const Eigen::AlignedBox3d box = a.box_world.intersection(b.box_world);
  if (!shared || box.isEmpty()) return points;
  const Eigen::Vector3d low = box.min() + Eigen::Vector3d(0.0, 0.0, kFloor_m);
  const Eigen::Array3d steps = ((box.max() - low).array() / kStep_m).floor();
  if ((steps < 0.0).any() || (steps + 1.0).prod() > kMost) return points;
  for (int z = 0; z <= static_cast<int>(steps.z()); ++z)
    for (int y = 0; y <= static_cast<int>(steps.y()); ++y)
      for (int x = 0; x <= static_cast<int>(steps.x()); ++x) {
        const Eigen::Vector3d p = low + kStep_m * Eigen::Vector3d(x, y, z);
        if (shared(p)) points.push_back(p);
      }
  return points;
}

double near_part(const Points& points, const Eigen::Isometry3d& T, const PointGrid& grid) {
  const auto near = std::count_if(points.begin(), points.end(),
                                  [&](const Eigen::Vector3d& p) { return grid.nearest(T * p).has_value(); });
  return static_cast<double>(near) / static_cast<double>(points.size());
}

/// Turns about z by `yaw_rad`, and brings one middle onto the other.
Eigen::Isometry3d turned(const Shape& before, const Shape& now, double yaw_rad) {
  Eigen::Isometry3d T(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  T.translation() = now.middle - T.linear() * before.middle;
  return T;
}

/// One step of iterative closest points, with a rotation about z. Returns the identity without enough pairs.
Eigen::Isometry3d step_of(const Shape& before, const Shape& now, const Eigen::Isometry3d& T, double most_m) {
  constexpr std::size_t kFewest = 10;
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pairs;
  for (const Eigen::Vector3d& p : before.points) {
    const Eigen::Vector3d moved = T * p;
    const std::optional<std::size_t> match = now.far->nearest(moved, most_m);
    if (!match) continue;
    pairs.emplace_back(moved, now.all[*match]);
    from += moved;
    to += now.all[*match];
  }
  if (pairs.size() < kFewest) return Eigen::Isometry3d::Identity();
  from /= static_cast<double>(pairs.size());
  to /= static_cast<double>(pairs.size());
  double cross = 0.0, dot = 0.0;
  for (const auto& [a, b] : pairs) {
    const Eigen::Vector2d u = (a - from).head<2>(), v = (b - to).head<2>();
    cross += u.x() * v.y() - u.y() * v.x();
    dot += u.dot(v);
  }
  Eigen::Isometry3d step(Eigen::AngleAxisd(std::atan2(cross, dot), Eigen::Vector3d::UnitZ()));
  step.translation() = to - step.linear() * from;
  return step;
}

/// Improves the transform with pairs that are nearer and nearer, so that what only one of the scans saw
/// attracts less.
Eigen::Isometry3d refined(const Shape& before, const Shape& now, Eigen::Isometry3d T) {
  constexpr int kMostSteps = 25;
  constexpr double kStill = 2e-4;  // m, and the sine of the rotation
  for (const double most_m : {2.0 * kSameSurface_m, 1.0 * kSameSurface_m, 0.5 * kSameSurface_m}) {
    for (int i = 0; i < kMostSteps; ++i) {
      const Eigen::Isometry3d step = step_of(before, now, T, most_m);
      T = step * T;
      const Eigen::Vector3d shift = step * (T * before.middle) - T * before.middle;
      if (shift.norm() < kStill && std::abs(step.linear()(1, 0)) < kStill) break;
    }
  }
  return T;
}

struct Comparison {
  Eigen::Isometry3d T_now_before = Eigen::Isometry3d::Identity();
  double least = 0.0, most = 0.0;  ///< coinciding fractions of both surfaces
  [[nodiscard]] double yaw_rad() const {
    return std::atan2(T_now_before.linear()(1, 0), T_now_before.linear()(0, 0));
  }
};

Comparison compare_at(const Shape& before, const Shape& now, const Eigen::Isometry3d& T) {
  const double a = near_part(before.points, T, *now.near);
  const double b = near_part(now.points, T.inverse(), *before.near);
  return {T, std::min(a, b), std::max(a, b)};
}

double apart_rad(const Comparison& a, const Comparison& b) {
  return std::abs(std::remainder(a.yaw_rad() - b.yaw_rad(), 2.0 * std::numbers::pi));
}

/// Compares two surfaces at all turns about z. Of turns that fit about as well, as those of a table by half a
/// turn, takes the smallest.
Comparison compare(const Shape& before, const Shape& now) {
  constexpr int kTurns = 48;
  constexpr std::size_t kRefined = 12;
  constexpr double kLeastAtFirst = 0.2, kPartOfBest = 0.6, kAsGood = 0.05, kTurned_rad = 0.14,
                   kOtherTurn_rad = 0.35;
  const auto fit_of = [](const Comparison& one) { return 0.5 * (one.least + one.most); };
  const auto is_better = [&](const Comparison& a, const Comparison& b) { return fit_of(a) > fit_of(b); };
  std::vector<Comparison> coarse, tried;
  for (int i = 0; i < kTurns; ++i) {
    const double yaw_rad = 2.0 * std::numbers::pi * i / kTurns;
    coarse.push_back(compare_at(before, now, turned(before, now, yaw_rad)));
  }
  std::stable_sort(coarse.begin(), coarse.end(), is_better);
  for (const Comparison& one : coarse) {
    const bool is_tried = std::any_of(tried.begin(), tried.end(), [&](const Comparison& other) {
      return apart_rad(one, other) < kTurned_rad;
    });
    const bool may_fit = fit_of(one) > std::max(kLeastAtFirst, kPartOfBest * fit_of(coarse.front()));
    if (may_fit && !is_tried && tried.size() < kRefined) tried.push_back(one);
  }
  for (Comparison& one : tried) one = compare_at(before, now, refined(before, now, one.T_now_before));
  std::stable_sort(tried.begin(), tried.end(), is_better);
  if (tried.empty()) return {};
  Comparison best = tried.front();
  for (const Comparison& one : tried)
    if (apart_rad(one, best) > kOtherTurn_rad && fit_of(one) > fit_of(tried.front()) - kAsGood &&
        std::abs(one.yaw_rad()) < std::abs(best.yaw_rad()))
      best = one;
  return best;
}

/// Sizes differ by what a scan did not see, but not by more.
bool may_be_one(const Shape& a, const Shape& b) {
  constexpr double kMostSize = 1.5;
  constexpr std::size_t kFewest = 20;
  return a.points.size() >= kFewest && b.points.size() >= kFewest && a.size_m < kMostSize * b.size_m &&
         b.size_m < kMostSize * a.size_m;
}

}  // namespace

SharedSurface surface_of_both(const StaticMap& a, const StaticMap& b, const Eigen::Isometry3d& T_b_a) {
  return [&a, &b, T_b_a](const Eigen::Vector3d& p) {
    const auto has_surface = [](const StaticMap& map, const Eigen::Vector3d& at) {
      const auto sample = map.sample_at(at);
      return sample ? std::abs(sample->distance_m) < 0.5F * kSameSurface_m
                    : map.occupancy_at(at) == Occupancy::kOccupied;
    };
    return has_surface(a, p) && has_surface(b, T_b_a * p);
  };
}

std::vector<MovedThing> find_moved_things(const std::vector<Change>& changes, const SharedSurface& shared) {
  constexpr double kLeast = 0.55, kMost = 0.75;
  std::vector<MovedThing> pairs;
  for (std::size_t v = 0; v < changes.size(); ++v) {
    for (std::size_t a = 0; a < changes.size(); ++a) {
      if (changes[v].kind != ChangeKind::kVanished || changes[a].kind != ChangeKind::kAppeared) continue;
      const Points both = shared_surface(changes[v], changes[a], shared);
      const Shape before(changes[v], both), now(changes[a], both);
      if (!may_be_one(before, now)) continue;
      const Comparison found = compare(before, now);
      if (found.least < kLeast || found.most < kMost) continue;
      pairs.push_back({v, a, found.T_now_before, found.yaw_rad() * 180.0 / std::numbers::pi,
                       (found.T_now_before * before.middle - before.middle).norm(), found.least});
    }
  }
  // Of things that look alike, such as chairs, each went to the place that is nearer.
  const auto likelihood = [](const MovedThing& pair) {
    constexpr double kPer_m = 0.05, kPerHalfTurn = 0.1;
    return pair.same_shape - kPer_m * pair.moved_m - kPerHalfTurn * std::abs(pair.turned_deg) / 180.0;
  };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const MovedThing& a, const MovedThing& b) { return likelihood(a) > likelihood(b); });
  std::vector<MovedThing> moved;
  std::set<std::size_t> used;
  for (const MovedThing& pair : pairs) {
    if (used.contains(pair.vanished) || used.contains(pair.appeared)) continue;
    used.insert({pair.vanished, pair.appeared});
    moved.push_back(pair);
  }
  return moved;
}

}  // namespace roomradar
