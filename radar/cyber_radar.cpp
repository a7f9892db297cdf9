// cyber_radar.cpp: M, then R from the nearest bound on, then L where it can be least.
#include "radar/cyber_radar.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mapping/types/error.hpp"
#include "radar/frame_along.hpp"
#include "radar/solid_inside.hpp"
#include "radar/thick_travel.hpp"

namespace roomradar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_valid(const RadarQuery& q) {
  return q.direction_world.allFinite() && q.direction_world.stableNorm() > 0.0 && q.distance_m > 0.0 &&
         std::isfinite(q.distance_m) && q.margin_m >= 0.0 && std::isfinite(q.margin_m) &&
         q.object.tree != nullptr && !q.object.tree->empty() && q.object.T_world_mesh.matrix().allFinite();
}

bool is_farther(const SceneItem& a, const SceneItem& b) { return a.low_m > b.low_m; }

/// What the gap of two triangles cannot be less than, cheaply: by their heights, and by the object's corners
/// under the scene's plane, extended. Infinite where the object slides along the scene.
double least_gap_bound(const FrameTriangle& object, const FrameTriangle& scene, double touching_m) {
  const auto& o = object.corners;
  const auto& s = scene.corners;
  const double by_height_m =
      std::min(std::min(s[0].z(), s[1].z()), s[2].z()) - std::max(std::max(o[0].z(), o[1].z()), o[2].z());
  if (std::abs(scene.normal.z()) <= kEdgeOn && !scene.normal.isZero(0.0)) {
    double low_m = kInfinity, high_m = -kInfinity;
    for (const Eigen::Vector3d& corner : o) {
      const double across_m = scene.normal.dot(corner - s[0]);
      low_m = std::min(low_m, across_m);
      high_m = std::max(high_m, across_m);
    }
    return low_m >= -touching_m || high_m <= touching_m ? kInfinity : by_height_m;  // slides along it
  }
  if (std::abs(scene.normal.z()) < 1e-3) return by_height_m;
  const double per_m = 1.0 / scene.normal.z();
  const double at_m = scene.normal.dot(s[0]);
  double by_plane_m = kInfinity;
  for (const Eigen::Vector3d& corner : o) {
    by_plane_m = std::min(by_plane_m, (at_m - scene.normal.dot(corner)) * per_m);
  }
  return std::max(by_height_m, by_plane_m - 1e-12);
}

}  // namespace

void require_valid(const RadarConfig& config) {
  if (config.resolution_px < 1 || config.resolution_px > 4096) {
    throw Error("radar.resolution_px = " + std::to_string(config.resolution_px) + ": must be in 1..4096");
  }
}

double touching_m(const TriangleTree& object) {
  return 1e-6 + 2.0 * std::numeric_limits<float>::epsilon() * object.half_size().cast<double>().norm();
}

CyberRadar::CyberRadar(const RadarConfig& config) : config_(config) { require_valid(config); }

/// Coarse for a direction that may never come again, finer where it is seen to stay. The exact answer does
/// not depend on how fine M is, and past kExact_px it is not found any sooner.
void CyberRadar::build_front(const TurnedTree& object) {
  constexpr int kExact_px = 64, kSeenToStay = 3;
  constexpr std::size_t kFewTriangles = 500;  // their M costs little at any size
  const int kept_px = config_.mode == RadarMode::kExact ? kExact_px : config_.resolution_px;
  const int fresh_px = std::min(24, kept_px);
  if (front_.holds(object)) {
    ++front_uses_;
    if (front_uses_ == kSeenToStay) front_.build(object, kept_px);
  } else {
    front_uses_ = 1;
    front_.build(object, object.tree->triangle_count() < kFewTriangles ? kept_px : fresh_px);
  }
}

Contact CyberRadar::query(const RadarQuery& query, const RadarScene& scene) {
  if (!is_valid(query)) return {};
  const TriangleTree& tree = *query.object.tree;
  const Eigen::Isometry3d& T_world_mesh = query.object.T_world_mesh;

  // The frame: origin at the object's middle, z along the direction. Fixed to the object, so that M stays as
  // it is while the direction does in the object's own frame, rounding of a turn aside.
  const Eigen::Vector3d u_mesh =
      (T_world_mesh.linear().transpose() * query.direction_world.stableNormalized()).normalized();
  if (!((u_mesh - u_mesh_).squaredNorm() < 1e-26)) u_mesh_ = u_mesh;
  TurnedTree object;
  object.tree = &tree;
  object.R_frame_mesh = frame_along(u_mesh_);
  object.margin_m = query.margin_m;
  object.touching_m = touching_m(tree);
  const Eigen::Matrix3d R_frame_world = object.R_frame_mesh * T_world_mesh.linear().transpose();
  const Eigen::Vector3d origin_world = T_world_mesh * (tree.origin() + tree.centre());
  if (!origin_world.allFinite()) return {};
  if (!scene_.place(scene, R_frame_world, origin_world)) return {};

  build_front(object);
  const bool is_thick = query.margin_m > 0.0;
  const double equally_m = object.touching_m;
  Eigen::AlignedBox3d volume = front_.bounds();
  const SceneBound bound{&front_, static_cast<float>(volume.min().z() - object.touching_m)};
  volume.max().z() += query.distance_m + equally_m;
  volume.min().z() -= object.touching_m;

  double best_m = kInfinity;
  bool leaves_something = false;  // which faces along the motion and crosses the object now
  bool met_a_back = false;        // of something that faces along the motion
  bool collects_backs = false;    // instead of meeting them
  backs_.clear();
  const auto limit_m = [&] {
    return std::min(best_m, query.distance_m) + (patch_.is_full() || is_thick ? 0.0 : equally_m);
  };
  // Says whether the object overlaps this scene triangle.
  const auto settle = [&](const SceneItem& item) {
    const FrameTriangle s = scene_.triangle(item);
    if (s.normal.z() > kEdgeOn && is_one_sided(scene_.kind(item))) return false;
    bool overlaps_here = false;
    bool has_ahead = is_thick && item.low_m < 0.0F;  // a thick object's triangles are not told apart
    const auto limit_here_m = [&] { return overlaps_here ? -kInfinity : limit_m(); };
    has_ahead |= search_column(object, s, limit_here_m, -object.touching_m, pending_, [&](std::uint32_t i) {
      if (is_thick) {
        best_m = std::min(best_m, thick_travel(turned_triangle(object, i), s, query.margin_m, limit_m()));
        return;
      }
      FrameTriangle o = turned_corners(object, i);
      if (least_gap_bound(o, s, object.touching_m) >= limit_m()) return;
      TriangleGap gap;
      if (!find_gap(o, s, gap)) return;
      has_ahead = has_ahead || gap.low_m < -object.touching_m;
      if (gap.low_m >= limit_m()) return;
      if (collects_backs && s.normal.z() > kEdgeOn) {
        backs_.push_back({gap.low_m, gap.high_m, i, item});
        return;
      }
      set_normal(o);
      switch (meeting_of(o, s, gap, object.touching_m)) {
        case Meeting::kNone:
          return;
        case Meeting::kCrossing:
          overlaps_here = true;
          return;
        case Meeting::kLeaving:
          leaves_something = true;
          return;
        case Meeting::kContact:
          break;
      }
      // The rear of a closed object only meets what is inside it.
      if (tree.is_closed() && o.normal.z() < -kEdgeOn) return;
      met_a_back = met_a_back || s.normal.z() > kEdgeOn;
      const double travel_m = std::max(gap.low_m, 0.0);
      best_m = std::min(best_m, travel_m);
      patch_.add(gap, travel_m, equally_m, s, scene_.kind(item), best_m);
    });
    if (has_ahead && !overlaps_here && s.normal.z() <= kEdgeOn) {
      overlaps_here = is_inside(object, s, pending_, layers_);
    }
    return overlaps_here;
  };

  bool overlaps = false;
  const auto look = [&] {
    patch_.clear();
    heap_.clear();
    scene_.begin(volume, bound, static_cast<float>(limit_m()), heap_);
    std::make_heap(heap_.begin(), heap_.end(), is_farther);
    int settled_count = 0;
    while (!heap_.empty() && !overlaps) {
      const SceneItem item = heap_.front();
      if (!(item.low_m < limit_m())) break;
      const bool is_enough = config_.mode == RadarMode::kSampled && !collects_backs &&
                             settled_count >= kSampledSettles && best_m <= query.distance_m &&
                             item.low_m >= 0.0F;
      if (is_enough || (is_thick && best_m <= 0.0)) break;
      std::pop_heap(heap_.begin(), heap_.end(), is_farther);
      heap_.pop_back();
      if (item.kind == SceneItem::Kind::kTriangle) {
        ++settled_count;
        overlaps = settle(item);
        continue;
      }
      found_.clear();
      scene_.expand(item, bound, static_cast<float>(limit_m()), found_);
      for (const SceneItem& part : found_) {
        heap_.push_back(part);
        std::push_heap(heap_.begin(), heap_.end(), is_farther);
      }
    }
  };
  look();
  // What is left, until it is left as a whole, is met by nothing; what faces so and comes after that is.
  if (leaves_something && met_a_back && !overlaps) {
    collects_backs = true;
    best_m = kInfinity;
    look();
    std::sort(backs_.begin(), backs_.end(), [](const Back& a, const Back& b) { return a.low_m < b.low_m; });
    double left_m = object.touching_m;
    for (const Back& back : backs_) {
      if (back.low_m <= left_m) {
        left_m = std::max(left_m, back.high_m + object.touching_m);
        continue;
      }
      const FrameTriangle o = turned_triangle(object, back.object_triangle);
      if (back.low_m >= best_m || (tree.is_closed() && o.normal.z() < -kEdgeOn)) continue;
      const FrameTriangle s = scene_.triangle(back.item);
      TriangleGap gap;
      if (!find_gap(o, s, gap)) continue;
      best_m = back.low_m;
      patch_.clear();
      patch_.add(gap, best_m, equally_m, s, scene_.kind(back.item), best_m);
      break;
    }
  }

  Contact contact;
  contact.status = ContactStatus::kNoTarget;
  contact.pixel_m = front_.side_m() / config_.resolution_px;
  contact.lower_m = query.distance_m;
  const auto to_world = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(origin_world + R_frame_world.transpose() * p);
  };
  const auto touch = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& normal, Touched kind) {
    contact.point_world = to_world(point);
    const Eigen::Vector3d facing = normal.isZero(0.0) ? -Eigen::Vector3d::UnitZ()
                                   : normal.z() > 0.0 ? Eigen::Vector3d(-normal)
                                                      : normal;
    contact.normal_world = R_frame_world.transpose() * facing;
    contact.touched = kind;
  };
  if (is_thick) {
    if (!overlaps && best_m > query.distance_m) return contact;
    contact.status = ContactStatus::kContact;
    const double unsettled_m = heap_.empty() ? kInfinity : heap_.front().low_m;  // sampled mode
    contact.lower_m = overlaps ? 0.0 : std::max(std::min(best_m, unsettled_m), 0.0);
    contact.travel_m = contact.lower_m;
    return contact;
  }
  if (overlaps) {
    const Overlap overlap = overlap_depth(object, front_, scene_, overlap_);
    contact.status = ContactStatus::kOverlap;
    contact.travel_m = contact.lower_m = contact.upper_m = -overlap.depth_m;
    touch(overlap.point, overlap.normal, overlap.kind);
    return contact;
  }
  if (!(best_m <= query.distance_m)) return contact;
  contact.status = ContactStatus::kContact;
  contact.travel_m = contact.upper_m = best_m;
  const double unsettled_m = heap_.empty() ? kInfinity : heap_.front().low_m;
  contact.lower_m = std::clamp(unsettled_m, 0.0, best_m);
  const PatchPoint middle = patch_.middle(best_m, equally_m);
  touch(middle.point, middle.normal, middle.kind);
  return contact;
}

}  // namespace roomradar
