// drop_request.cpp: finds a place in view on the room's own depth.
#include "app/session/drop_request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "app/physics/physics.hpp"
#include "app/physics/placement/placement.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns the room's depth; 0 where something dynamic is in front of it and might stand on it.
DepthImage seen_room_depth_m(const ExpectedView& expected, const FrameForeground& foreground) {
  DepthImage depth_m = expected.depth_m;
  const MaskImage& moved = foreground.dynamic_mask;
  for (std::size_t i = 0; i < std::min(moved.pixels.size(), depth_m.pixels.size()); ++i)
    if (moved.pixels[i] != 0) depth_m.pixels[i] = 0.0F;
  return depth_m;
}

/// Returns true if an object at the start of its fall, and on its way down, is clear of everything, and the
/// surface that it meets is the room's own at the expected height.
bool is_fall_free(const VirtualObject& object, const Eigen::Isometry3d& T_world_start, double height_m,
                  const DropScene& scene) {
  constexpr double kClearance_m = 0.02;  // sideways, and above the object
  constexpr double kUnevenness_m = 0.02;
  const PlacementConfig placement;
  const double slope = std::tan(placement.max_tilt_deg * (std::numbers::pi / 180.0));
  const double early_m = slope * footprint_radius_m(object, T_world_start.linear()) + kUnevenness_m;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const TreeInstance at_start{&object.model->shape.touched, T_world_start};
  const RadarScene surfaces{scene.surfaces, {}};
  if (is_in_solid_unknown(scene.room, object, T_world_start)) return false;
  const Contact around = scene.radar.query({at_start, down, height_m + kClearance_m, kClearance_m}, surfaces);
  if (!(around.lower_m >= height_m - kClearance_m - early_m)) return false;
  const Contact below = scene.radar.query({at_start, down, height_m + kUnevenness_m + early_m}, surfaces);
  // Without the map, only the frame's own surfaces exist.
  const bool has_map = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                   [](const SceneTree& s) { return s.kind == SurfaceKind::kStatic; });
  return below.status == ContactStatus::kContact &&
         below.touched == (has_map ? SurfaceKind::kStatic : SurfaceKind::kDynamic);
}

/// Simulates the fall against the surfaces as they are in this frame. Returns true if the object then is at
/// rest, within 5 cm of its start seen from above and turned by at most 30 degrees.
bool stays_after_fall(const VirtualObject& object, const Eigen::Isometry3d& T_world_start,
                      const DropScene& scene) {
  constexpr double kMostMoved_m = 0.05, kMostTurned_deg = 30.0;
  constexpr double kStep_s = 1.0 / 30.0;
  constexpr int kMostSteps = 90;
  Body body = object.body;
  body.T_world_object = T_world_start;
  body.velocity_world_mps.setZero();
  body.angular_velocity_world_rad_s.setZero();
  body.asleep = false;
  body.sleep_timer_s = 0.0;
  body.supporting_bodies.clear();
  const RadarScene surfaces{scene.surfaces, {}};
  const CollisionQueries probe = make_collision_queries(scene.radar, object.model->shape.touched, surfaces);
  const Eigen::Vector3d start_world = T_world_start * object.model->middle;
  for (int step = 0; step < kMostSteps && !body.asleep; ++step) {
    if (advance(body, kStep_s, probe, scene.physics).status != StepStatus::kMoved) return false;
    const Eigen::Vector3d moved_m = body.T_world_object * object.model->middle - start_world;
    const double turned_deg =
        Eigen::AngleAxisd(body.T_world_object.linear() * T_world_start.linear().transpose()).angle() *
        (180.0 / std::numbers::pi);
    if (moved_m.head<2>().norm() > kMostMoved_m || turned_deg > kMostTurned_deg) return false;
  }
  return body.asleep;
}

/// Returns the end of a sentence that says why an object is dropped from less than the requested height.
std::string note_of_height(double height_m, double requested_m) {
  if (height_m == requested_m) return {};
  std::array<char, 160> text{};
  format_classic(text.data(), text.size(),
                 " is dropped from %.3g m, since it would topple or move away if dropped from %.3g m",
                 height_m, requested_m);
  return text.data();
}

/// Returns the end of a sentence: the reason why there is no place.
std::string reason_of(SupportStatus status, double footprint_radius_m) {
  std::array<char, 160> text{};
  switch (status) {
    case SupportStatus::kNothingMeasured:
      return "the map has no surface between 0.4 and 4 m in this view";
    case SupportStatus::kNotLevel:
      return "the map has no level surface in this view";
    case SupportStatus::kTooSmall:
      format_classic(text.data(), text.size(),
                     "it needs a free circle %.2f m across, and no level surface in this view has one",
                     2.0 * (footprint_radius_m + PlacementConfig{}.room_to_spare_m));
      return text.data();
    case SupportStatus::kTooFar:
      format_classic(text.data(), text.size(),
                     "it needs a free level circle %.2f m across, and none is within %.0f cm of that point",
                     2.0 * (footprint_radius_m + PlacementConfig{}.room_to_spare_m),
                     100.0 * PlacementConfig{}.max_away_m);
      return text.data();
    case SupportStatus::kBlocked:
      return "something is in the way above or beside every level surface that is large enough, or that "
             "space was not scanned";
    case SupportStatus::kInvalidInput:
    case SupportStatus::kFound:
      break;
  }
  return "the frame has no usable depth";
}

}  // namespace

void require_small_enough(const VirtualObject& object, const DropRequest& drop) {
  const double reach_m =
      footprint_radius_m(object, drop.R_world_object.value_or(object.body.T_world_object.linear()));
  if (reach_m <= kMostFootprint_m) return;
  std::array<char, 320> text{};
  format_classic(
      text.data(), text.size(),
      ": reaches %.3g m sideways from its middle, and only what reaches at most %.0f m is dropped in view. "
      "Make it smaller, in metres (--object FILE,size=0.2; add NAME FILE size 0.2), or say the place "
      "(at=X,Y,Z; drop NAME at X Y Z)",
      reach_m, kMostFootprint_m);
  throw Error(object.body.name + text.data());
}

DropPosition find_drop_position(const VirtualObject& object, const DropRequest& drop, const DropView& view,
                                const DropScene& scene) {
  const Eigen::Matrix3d R_world_object = drop.R_world_object.value_or(object.body.T_world_object.linear());
  const Eigen::Vector3d to_middle = level_to_middle(object, R_world_object);
  const auto start = [&](const Eigen::Vector3d& point_world, double height_m) {
    Eigen::Isometry3d T_world_start = Eigen::Isometry3d::Identity();
    T_world_start.linear() = R_world_object;
    T_world_start.translation() = point_world - to_middle;
    T_world_start.translation().z() += height_m - lowest_m(object, R_world_object);
    return T_world_start;
  };
  constexpr int kMostTried = 6;
  int tried = 0;
  std::optional<Eigen::Vector3d> first_free;
  double height_m = drop.height_m;
  const auto is_free = [&](const Eigen::Vector3d& point_world) {
    if (tried == kMostTried) return false;
    if (!is_fall_free(object, start(point_world, drop.height_m), drop.height_m, scene)) return false;
    if (!first_free) first_free = point_world;
    ++tried;
    const auto stays_from = [&](double from_m) {
      height_m = from_m;
      return stays_after_fall(object, start(point_world, from_m), scene);
    };
    return stays_from(drop.height_m) || (drop.height_m > kGentleDrop_m && stays_from(kGentleDrop_m));
  };
  const double radius_m = footprint_radius_m(object, R_world_object);
  const Support support = find_support(seen_room_depth_m(view.expected, view.foreground), view.camera,
                                       view.T_world_camera, {radius_m, drop.near_world, is_free});
  if (support) return {support.point_world - to_middle, height_m, note_of_height(height_m, drop.height_m)};
  if (first_free)
    return {*first_free - to_middle, drop.height_m,
            " may not stay where it is dropped: it topples, rolls or slides on every level surface that was "
            "tried"};
  return {std::nullopt, 0.0, reason_of(support.status, radius_m)};
}

}  // namespace roomradar
