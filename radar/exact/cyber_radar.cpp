// cyber_radar.cpp: M first, then R from the least bound on, then L where it can be least.
#include "radar/exact/cyber_radar.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "radar/exact/contact_patch.hpp"
#include "radar/exact/overlap_depth.hpp"
#include "radar/exact/radar_query.hpp"
#include "radar/geometry/column_search.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/frame_along.hpp"
#include "radar/geometry/infinity.hpp"
#include "radar/geometry/inflated_distance.hpp"
#include "radar/geometry/solid_inside.hpp"

namespace roomradar {

/// One query of CyberRadar in the frame of its motion, and the results of its exact tests so far. The frame
/// has its origin at the object's centre and its z axis along the direction of motion. Relative to the
/// object, the frame depends only on the direction. The object's height map M can thus be reused while the
/// direction in the object's frame is unchanged.
struct RadarSearch {
  const RadarQuery& query;
  const TriangleTree& tree;
  TurnedTree object;
  Eigen::Matrix3d R_frame_world;
  Eigen::Vector3d origin_world;
  /// True if the object is inflated (RadarQuery::margin_m > 0).
  bool is_thick;

  /// Least distance to contact found by an exact test, m.
  double best_m = kInfinity<double>;
  /// True if an exact test found an overlap. The search for contacts then ends.
  bool overlaps = false;
  /// The scene triangle that the object overlaps; set if `overlaps`.
  OverlappedTriangle overlapped;
  /// True if the object intersects a back-facing surface now.
  bool leaves_something = false;
  /// True if a contact with a back-facing surface was found ahead.
  bool met_a_back = false;
  /// True if back-facing surfaces are collected instead of counted as contacts.
  bool collects_backs = false;
  /// True if surfaces that may be behind M were left untested (see CyberRadar::kMostWorkBehind).
  bool is_cut_short = false;

  /// @param q       the query; must outlive the search
  /// @param u_mesh  unit direction of motion in the object's frame
  RadarSearch(const RadarQuery& q, const Eigen::Vector3d& u_mesh)
      : query(q), tree(*q.object.tree), is_thick(q.margin_m > 0.0) {
    object.tree = &tree;
    object.R_frame_mesh = frame_along(u_mesh);
    object.margin_m = q.margin_m;
    object.touching_m = touching_m(tree);
    R_frame_world = object.R_frame_mesh * q.object.T_world_mesh.linear().transpose();
    origin_world = q.object.T_world_mesh * (tree.origin() + tree.centre());
  }
  /// Returns the tolerance within which contacts count as equally near, m.
  [[nodiscard]] double equally_m() const { return object.touching_m; }
  /// Returns true if the object is closed and its triangle `o` faces against the motion.
  [[nodiscard]] bool is_rear(const FrameTriangle& o) const {
    return tree.is_closed() && o.normal.z() < -kEdgeOn;
  }
};

/// Sets the contact's point, normal and kind from a point in the search's frame. A normal that faces along
/// the motion is negated. A zero normal is replaced by the direction opposite to the motion.
inline void touch(const RadarSearch& search, const PatchPoint& at, Contact& contact) {
  const Eigen::Matrix3d R_world_frame = search.R_frame_world.transpose();
  contact.point_world = search.origin_world + R_world_frame * at.point;
  const Eigen::Vector3d facing = at.normal.isZero(0.0) ? -Eigen::Vector3d::UnitZ()
                                 : at.normal.z() > 0.0 ? Eigen::Vector3d(-at.normal)
                                                       : at.normal;
  contact.normal_world = R_world_frame * facing;
  contact.touched = at.kind;
}

CyberRadar::CyberRadar(const RadarConfig& config) : config_(config) { require_valid(config); }

Contact CyberRadar::query(const RadarQuery& query, const RadarScene& scene) {
  if (!is_valid(query)) return {};
  RadarSearch search(query, front_.direction_in_object(query));
  if (!search.origin_world.allFinite()) return {};
  if (!scene_.place(scene, query.own_tree, search.R_frame_world, search.origin_world)) return {};
  front_.turn(search.object);
  scene_.enter(volume_ahead(search));
  front_.build(search.object, scene_, config_);  // M
  look(search);                                  // R, L
  front_.add_work(columns_.work);
  if (search.leaves_something && search.met_a_back && !search.overlaps && !search.is_cut_short) leave(search);
  if (search.is_thick) return inflated_contact_of(search);
  return search.overlaps ? overlap_of(search) : contact_of(search);
}

/// Returns the volume that the object sweeps, in its frame.
Eigen::AlignedBox3d CyberRadar::volume_ahead(const RadarSearch& search) const {
  Eigen::AlignedBox3d volume = front_.bounds();
  volume.min().z() -= search.object.touching_m;
  volume.max().z() += search.query.distance_m + search.equally_m();
  return volume;
}

SceneBound CyberRadar::bound_of(const RadarSearch& search) const {
  return {&front_.map(), static_cast<float>(volume_ahead(search).min().z())};
}

/// Returns the distance beyond which the search stops.
double CyberRadar::limit_m(const RadarSearch& search) const {
  const bool wants_equals = !patch_.is_full() && !search.is_thick;
  return std::min(search.best_m, search.query.distance_m) + (wants_equals ? search.equally_m() : 0.0);
}

/// Runs exact tests from the least bound on, until nothing can be nearer or enough is known.
void CyberRadar::look(RadarSearch& search) {
  const double distance_m = search.query.distance_m;
  const SceneBound bound = bound_of(search);
  const bool may_stop_early = config_.mode == RadarMode::kSampled && !search.collects_backs;
  int tested_count = 0;
  columns_.work = 0;
  backs_.clear();
  patch_.clear();
  queue_.clear();
  scene_.begin(bound, static_cast<float>(limit_m(search)), queue_.items());
  queue_.arrange();
  while (!queue_.empty() && !search.overlaps && queue_.least().low_m < limit_m(search)) {
    const bool is_enough = may_stop_early && tested_count >= kSampledExactTests &&
                           search.best_m <= distance_m && queue_.least().low_m >= 0.0F;
    if (is_enough || (search.is_thick && search.best_m <= 0.0)) return;
    SceneItem item = queue_.pop();
    columns_.work += 2;
    if (item.low_m < 0.0F && columns_.work > kMostWorkBehind && !search.is_thick) {
      cut_short(search);
      continue;
    }
    if (!item.is_triangle()) {
      found_.clear();
      scene_.expand(item, bound, static_cast<float>(limit_m(search)), found_);
      for (const SceneItem& part : found_) queue_.push(part);
      continue;
    }
    const FrameTriangle triangle = scene_.triangle(item);
    if (item.kind == SceneItem::Kind::kTriangle) {
      static_triangles_asked_ += scene_.kind(item) == SurfaceKind::kStatic ? 1 : 0;
      item.kind = SceneItem::Kind::kBounded;
      item.low_m = std::max(item.low_m, bound.low_m(triangle));
      if (!(item.low_m < limit_m(search))) continue;
      if (!queue_.empty() && queue_.least().low_m < item.low_m) {
        queue_.push(item);
        continue;
      }
    }
    ++tested_count;
    test_exactly(search, item, triangle);
  }
}

/// Drops everything that may be behind the object's front, and continues with what is certainly ahead.
void CyberRadar::cut_short(RadarSearch& search) {
  queue_.drop_below_zero();
  search.is_cut_short = true;
  search.collects_backs = true;  // unknown which back-facing surfaces are left, so none is a contact
  if (!search.met_a_back) return;
  search.best_m = kInfinity<double>;
  patch_.clear();
}

/// Tests a scene triangle exactly against all object triangles in its column.
void CyberRadar::test_exactly(RadarSearch& search, const SceneItem& item, const FrameTriangle& s) {
  if (s.normal.z() > kEdgeOn && is_one_sided(scene_.kind(item))) return;
  const TurnedTree& object = search.object;
  // For an inflated object, layers are not distinguished.
  bool has_ahead = search.is_thick && item.low_m < 0.0F;
  const auto limit = [&] { return search.overlaps ? -kInfinity<double> : limit_m(search); };
  has_ahead |= search_column(object, s, limit, -object.touching_m, columns_, [&](std::uint32_t i) {
    if (search.is_thick) {
      const double contact_distance_m =
          inflated_distance(turned_triangle(object, i), s, search.query.margin_m, limit_m(search));
      search.best_m = std::min(search.best_m, contact_distance_m);
      return;
    }
    FrameTriangle o = turned_corners(object, i);
    const double least_m = least_gap_bound(o, s, object.touching_m);
    if (least_m >= limit_m(search)) return;
    // The rear of a closed object touches only scene inside it. Cheap to test if much scene is behind the
    // front.
    const bool is_ahead = item.low_m < 0.0F && least_m > object.touching_m;
    if (is_ahead) set_normal(o);
    if (is_ahead && search.is_rear(o)) return;
    TriangleGap gap;
    if (!find_gap(o, s, gap)) return;
    has_ahead = has_ahead || gap.low_m < -object.touching_m;
    if (gap.low_m >= limit_m(search)) return;
    if (search.collects_backs && s.normal.z() > kEdgeOn) {
      if (!search.is_cut_short) backs_.push_back({gap.low_m, gap.high_m, i, item});
      return;
    }
    set_normal(o);
    switch (classify_pair(o, s, gap, object.touching_m)) {
      case PairContact::kNone:
        return;
      case PairContact::kCrossing:
        search.overlaps = true;
        search.overlapped = {s, scene_.kind(item)};
        return;
      case PairContact::kLeaving:
        search.leaves_something = true;
        return;
      case PairContact::kContact:
        break;
    }
    if (search.is_rear(o)) return;
    search.met_a_back = search.met_a_back || s.normal.z() > kEdgeOn;
    const double contact_distance_m = std::max(gap.low_m, 0.0);
    search.best_m = std::min(search.best_m, contact_distance_m);
    patch_.add(gap, contact_distance_m, search.equally_m(), s, scene_.kind(item), search.best_m);
  });
  if (has_ahead && !search.overlaps && s.normal.z() <= kEdgeOn) {
    search.overlaps = is_inside(object, s, columns_, layers_);
    if (search.overlaps) search.overlapped = {s, scene_.kind(item)};
  }
}

/// Finds the first contact with a back-facing surface after the surface being left has been passed as a
/// whole.
void CyberRadar::leave(RadarSearch& search) {
  search.collects_backs = true;
  search.best_m = kInfinity<double>;
  look(search);
  if (search.is_cut_short) return;
  std::sort(backs_.begin(), backs_.end(), [](const Back& a, const Back& b) { return a.low_m < b.low_m; });
  double left_m = search.object.touching_m;
  for (const Back& back : backs_) {
    if (back.low_m <= left_m) {
      left_m = std::max(left_m, back.high_m + search.object.touching_m);
      continue;
    }
    const FrameTriangle o = turned_triangle(search.object, back.object_triangle);
    if (back.low_m >= search.best_m || search.is_rear(o)) continue;
    const FrameTriangle s = scene_.triangle(back.item);
    TriangleGap gap;
    if (!find_gap(o, s, gap)) continue;
    search.best_m = back.low_m;
    patch_.clear();
    patch_.add(gap, back.low_m, search.equally_m(), s, scene_.kind(back.item), back.low_m);
    return;
  }
}

Contact CyberRadar::nothing_found(const RadarSearch& search) const {
  Contact contact;
  contact.status = ContactStatus::kNoTarget;
  contact.pixel_m = front_.map().side_m() / config_.resolution_px;
  contact.lower_m = search.query.distance_m;
  return contact;
}

/// Returns a lower bound of the distance of every contact not found yet.
double CyberRadar::least_untested_m(const RadarSearch& search) const {
  if (search.is_cut_short) return 0.0;
  return queue_.empty() ? kInfinity<double> : std::max(queue_.least().low_m, 0.0F);
}

Contact CyberRadar::inflated_contact_of(const RadarSearch& search) const {
  Contact contact = nothing_found(search);
  const double free_m = search.overlaps ? 0.0 : std::min(search.best_m, least_untested_m(search));
  if (free_m > search.query.distance_m) return contact;
  contact.status = ContactStatus::kContact;
  contact.contact_distance_m = contact.lower_m = free_m;
  return contact;
}

Contact CyberRadar::overlap_of(const RadarSearch& search) {
  Contact contact = nothing_found(search);
  const Overlap overlap = overlap_depth(search.object, front_.map(), scene_, search.overlapped, overlap_);
  contact.status = ContactStatus::kOverlap;
  contact.contact_distance_m = contact.upper_m = -overlap.depth_m;
  contact.lower_m = overlap.is_all ? -overlap.depth_m : -kInfinity<double>;
  touch(search, {overlap.point, overlap.normal, overlap.kind}, contact);
  return contact;
}

Contact CyberRadar::contact_of(RadarSearch& search) {
  Contact contact = nothing_found(search);
  contact.lower_m = std::min({search.best_m, least_untested_m(search), search.query.distance_m});
  if (!(search.best_m <= search.query.distance_m)) return contact;
  contact.status = ContactStatus::kContact;
  contact.contact_distance_m = contact.upper_m = search.best_m;
  const Eigen::Vector2d middle = patch_.middle(search.best_m, search.equally_m());
  if (!patch_.has_all()) look_over(search, middle);
  touch(search, patch_.nearest(middle, search.best_m, search.equally_m()), contact);
  return contact;
}

/// Finds the piece at this place again if more pieces were found than are stored.
void CyberRadar::look_over(RadarSearch& search, const Eigen::Vector2d& place) {
  const SceneBound bound = bound_of(search);
  const auto limit = static_cast<float>(search.best_m + search.equally_m());
  patch_.forget_sums();
  std::vector<SceneItem>& items = queue_.items();  // in any order
  items.clear();
  scene_.begin(bound, limit, items);
  while (!items.empty()) {
    const SceneItem item = items.back();
    items.pop_back();
    if (!item.is_triangle()) {
      scene_.expand(item, bound, limit, items);
      continue;
    }
    const FrameTriangle triangle = scene_.triangle(item);
    Eigen::AlignedBox2d outline;
    for (const Eigen::Vector3d& corner : triangle.corners) outline.extend(corner.head<2>());
    if (outline.contains(place)) test_exactly(search, item, triangle);
  }
}

}  // namespace roomradar
