// cyber_radar.cpp: M first, then R from the least bound on, then L where it can be least.
#include "radar/exact/cyber_radar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mapping/types/system/config_check.hpp"
#include "radar/geometry/frame_along.hpp"
#include "radar/geometry/infinity.hpp"
#include "radar/geometry/inflated_distance.hpp"
#include "radar/geometry/solid_inside.hpp"

namespace roomradar {
namespace {

bool is_farther(const SceneItem& a, const SceneItem& b) { return a.low_m > b.low_m; }

void push(std::vector<SceneItem>& heap, const SceneItem& item) {
  heap.push_back(item);
  std::push_heap(heap.begin(), heap.end(), is_farther);
}
SceneItem pop(std::vector<SceneItem>& heap) {
  std::pop_heap(heap.begin(), heap.end(), is_farther);
  const SceneItem item = heap.back();
  heap.pop_back();
  return item;
}

/// Returns the cost of building M, in units of ColumnScratch::work; triangles smaller than a pixel are
/// entered together.
std::uint64_t work_to_build(const TurnedTree& object, int px) {
  const auto pixels = static_cast<std::uint64_t>(px) * static_cast<std::uint64_t>(px);
  return std::min<std::uint64_t>(object.tree->triangle_count() / 2, pixels) + pixels / 50;
}

/// Returns a cheap lower bound of the gap between two triangles, from their heights and from the object's
/// corners under the scene's extended plane. Infinite if the object slides along the scene.
double least_gap_bound(const FrameTriangle& object, const FrameTriangle& scene, double touching_m) {
  const auto& o = object.corners;
  const auto& s = scene.corners;
  const double by_height_m =
      std::min(std::min(s[0].z(), s[1].z()), s[2].z()) - std::max(std::max(o[0].z(), o[1].z()), o[2].z());
  if (std::abs(scene.normal.z()) <= kEdgeOn && !scene.normal.isZero(0.0)) {
    double low_m = kInfinity<double>, high_m = -kInfinity<double>;
    for (const Eigen::Vector3d& corner : o) {
      const double across_m = scene.normal.dot(corner - s[0]);
      low_m = std::min(low_m, across_m);
      high_m = std::max(high_m, across_m);
    }
    return low_m >= -touching_m || high_m <= touching_m ? kInfinity<double> : by_height_m;  // slides along it
  }
  if (std::abs(scene.normal.z()) < 1e-3) return by_height_m;
  const double per_m = 1.0 / scene.normal.z();
  double by_plane_m = kInfinity<double>, size_m = s[0].lpNorm<1>();
  for (const Eigen::Vector3d& corner : o) {
    by_plane_m = std::min(by_plane_m, scene.normal.dot(s[0] - corner) * per_m);
    size_m = std::max(size_m, corner.lpNorm<1>());
  }
  // Rounding of a difference, a product and a sum of three, and the tilt by the normal's own rounding.
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::max(by_height_m, by_plane_m - kRounding * size_m * std::abs(per_m));
}

}  // namespace

void require_valid(const RadarConfig& config) {
  const ConfigCheck require{"radar"};
  require(config.resolution_px >= 1 && config.resolution_px <= 4096, "resolution_px", config.resolution_px,
          "in 1..4096");
}

bool is_valid(const RadarQuery& q) {
  return q.direction_world.allFinite() && q.direction_world.stableNorm() > 0.0 && q.distance_m > 0.0 &&
         std::isfinite(q.distance_m) && q.margin_m >= 0.0 && std::isfinite(q.margin_m) &&
         q.object.tree != nullptr && !q.object.tree->empty() && q.object.T_world_mesh.matrix().allFinite();
}

double touching_m(const TriangleTree& object) {
  return 1e-6 + 2.0 * std::numeric_limits<float>::epsilon() * object.half_size().cast<double>().norm();
}

CyberRadar::CyberRadar(const RadarConfig& config) : config_(config) { require_valid(config); }

/// One query, in its frame: origin at the object's middle, z along the direction. The frame is fixed to the
/// object, so M stays valid while the direction is unchanged in the object's own frame.
struct CyberRadar::Search {
  const RadarQuery& query;
  const TriangleTree& tree;
  TurnedTree object;
  Eigen::Matrix3d R_frame_world;
  Eigen::Vector3d origin_world;
  bool is_thick;

  double best_m = kInfinity<double>;  // least distance from an exact test
  bool overlaps = false;              // found by an exact test; nothing else matters then
  OverlappedTriangle overlapped;      // if overlaps
  bool leaves_something = false;      // a back-facing surface crosses the object now
  bool met_a_back = false;            // contact with a back-facing surface
  bool collects_backs = false;        // instead of treating them as contacts
  bool is_cut_short = false;          // not all scene that may be behind the front was tested

  Search(const RadarQuery& q, const Eigen::Vector3d& u_mesh)
      : query(q), tree(*q.object.tree), is_thick(q.margin_m > 0.0) {
    object.tree = &tree;
    object.R_frame_mesh = frame_along(u_mesh);
    object.margin_m = q.margin_m;
    object.touching_m = touching_m(tree);
    R_frame_world = object.R_frame_mesh * q.object.T_world_mesh.linear().transpose();
    origin_world = q.object.T_world_mesh * (tree.origin() + tree.centre());
  }
  /// Contacts at most this much farther than the nearest count as equally near.
  [[nodiscard]] double equally_m() const { return object.touching_m; }
  [[nodiscard]] bool is_rear(const FrameTriangle& o) const {
    return tree.is_closed() && o.normal.z() < -kEdgeOn;
  }
};

Contact CyberRadar::query(const RadarQuery& query, const RadarScene& scene) {
  if (!is_valid(query)) return {};
  Search search(query, direction_in_object(query));
  if (!search.origin_world.allFinite()) return {};
  if (!scene_.place(scene, query.own_tree, search.R_frame_world, search.origin_world)) return {};
  const bool is_kept = front_.holds(search.object);
  front_.turn(search.object);
  scene_.enter(volume_ahead(search));
  build_front(search.object, is_kept);  // M
  look(search);                         // R, L
  front_work_ += columns_.work;
  if (search.leaves_something && search.met_a_back && !search.overlaps && !search.is_cut_short) leave(search);
  if (search.is_thick) return inflated_contact_of(search);
  return search.overlaps ? overlap_of(search) : contact_of(search);
}

/// Returns the unit direction in the object's frame. Reuses the last one if only rounding differs, so M stays
/// valid.
Eigen::Vector3d CyberRadar::direction_in_object(const RadarQuery& query) {
  const Eigen::Vector3d u_mesh =
      (query.object.T_world_mesh.linear().transpose() * query.direction_world.stableNormalized())
          .normalized();
  if (!((u_mesh - u_mesh_).squaredNorm() < 1e-26)) u_mesh_ = u_mesh;
  return u_mesh_;
}

/// Returns the volume that the object sweeps, in its frame.
Eigen::AlignedBox3d CyberRadar::volume_ahead(const Search& search) const {
  Eigen::AlignedBox3d volume = front_.bounds();
  volume.min().z() -= search.object.touching_m;
  volume.max().z() += search.query.distance_m + search.equally_m();
  return volume;
}

SceneBound CyberRadar::bound_of(const Search& search) const {
  return {&front_, static_cast<float>(volume_ahead(search).min().z())};
}

/// Builds a coarse M for a new direction, and a finer one once the direction has repeated so often that the
/// finer M would have paid by now. M's pixels then rule out nearly all of the scene, whatever the object's
/// triangles are. The exact result does not depend on M's resolution.
void CyberRadar::build_front(const TurnedTree& object, bool is_kept) {
  constexpr int kFewFresh_px = 64;
  constexpr int kFinest_px = 384;  // unless config_.resolution_px is finer
  const std::array kept_px{96, 192, kFinest_px, std::max(kFinest_px, config_.resolution_px)};
  constexpr std::size_t kFewTriangles = 500;  // fewer make a cheap M
  const bool is_exact = config_.mode == RadarMode::kExact;
  const auto at_most_asked = [&](int px) {
    return is_exact ? std::min(px, kFinest_px) : std::min(px, config_.resolution_px);
  };
  if (!is_kept) {
    front_work_ = 0;
    const bool has_few = object.tree->triangle_count() < kFewTriangles;
    front_.build(object, at_most_asked(has_few ? kFewFresh_px : fresh_px()));
    return;
  }
  int finest_px = 0;
  for (const int px : kept_px)
    if (2 * front_work_ > work_to_build(object, at_most_asked(px))) finest_px = at_most_asked(px);
  if (finest_px > 0) front_.build(object, finest_px);
}

/// Returns the resolution of M for a new direction. The more scene there is to rule out, the finer an M pays:
/// its time grows with its pixels, and the pairs left for exact tests shrink with them.
int CyberRadar::fresh_px() const {
  constexpr int kLeast_px = 8, kMost_px = 40, kOverTrees_px = 24;
  if (scene_.has_trees()) return kOverTrees_px;
  const double px = 2.5 * std::sqrt(std::sqrt(static_cast<double>(scene_.cell_count())));
  return std::clamp(static_cast<int>(px), kLeast_px, kMost_px);
}

/// Returns the distance beyond which the search stops.
double CyberRadar::limit_m(const Search& search) const {
  const bool wants_equals = !patch_.is_full() && !search.is_thick;
  return std::min(search.best_m, search.query.distance_m) + (wants_equals ? search.equally_m() : 0.0);
}

/// Runs exact tests from the least bound on, until nothing can be nearer or enough is known.
void CyberRadar::look(Search& search) {
  const double distance_m = search.query.distance_m;
  const SceneBound bound = bound_of(search);
  const bool may_stop_early = config_.mode == RadarMode::kSampled && !search.collects_backs;
  int settled_count = 0;
  columns_.work = 0;
  backs_.clear();
  patch_.clear();
  heap_.clear();
  scene_.begin(bound, static_cast<float>(limit_m(search)), heap_);
  std::make_heap(heap_.begin(), heap_.end(), is_farther);
  while (!heap_.empty() && !search.overlaps && heap_.front().low_m < limit_m(search)) {
    const bool is_enough = may_stop_early && settled_count >= kSampledExactTests &&
                           search.best_m <= distance_m && heap_.front().low_m >= 0.0F;
    if (is_enough || (search.is_thick && search.best_m <= 0.0)) return;
    SceneItem item = pop(heap_);
    columns_.work += 2;
    if (item.low_m < 0.0F && columns_.work > kMostWorkBehind && !search.is_thick) {
      cut_short(search);
      continue;
    }
    if (!item.is_triangle()) {
      found_.clear();
      scene_.expand(item, bound, static_cast<float>(limit_m(search)), found_);
      for (const SceneItem& part : found_) push(heap_, part);
      continue;
    }
    const FrameTriangle triangle = scene_.triangle(item);
    if (item.kind == SceneItem::Kind::kTriangle) {
      static_triangles_asked_ += scene_.kind(item) == SurfaceKind::kStatic ? 1 : 0;
      item.kind = SceneItem::Kind::kBounded;
      item.low_m = std::max(item.low_m, bound.low_m(triangle));
      if (!(item.low_m < limit_m(search))) continue;
      if (!heap_.empty() && heap_.front().low_m < item.low_m) {
        push(heap_, item);
        continue;
      }
    }
    ++settled_count;
    test_exactly(search, item, triangle);
  }
}

/// Drops everything that may be behind the object's front, and continues with what is certainly ahead.
void CyberRadar::cut_short(Search& search) {
  std::erase_if(heap_, [](const SceneItem& item) { return item.low_m < 0.0F; });
  std::make_heap(heap_.begin(), heap_.end(), is_farther);
  search.is_cut_short = true;
  search.collects_backs = true;  // which back-facing surfaces are left is unknown: none of them is a contact
  if (!search.met_a_back) return;
  search.best_m = kInfinity<double>;
  patch_.clear();
}

/// Tests a scene triangle exactly against all object triangles in its column.
void CyberRadar::test_exactly(Search& search, const SceneItem& item, const FrameTriangle& s) {
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
void CyberRadar::leave(Search& search) {
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

Contact CyberRadar::nothing_found(const Search& search) const {
  Contact contact;
  contact.status = ContactStatus::kNoTarget;
  contact.pixel_m = front_.side_m() / config_.resolution_px;
  contact.lower_m = search.query.distance_m;
  return contact;
}

/// Returns a lower bound of the distance of every contact not found yet.
double CyberRadar::least_unsettled_m(const Search& search) const {
  if (search.is_cut_short) return 0.0;
  return heap_.empty() ? kInfinity<double> : std::max(heap_.front().low_m, 0.0F);
}

void CyberRadar::touch(const Search& search, const PatchPoint& at, Contact& contact) {
  const Eigen::Matrix3d R_world_frame = search.R_frame_world.transpose();
  contact.point_world = search.origin_world + R_world_frame * at.point;
  const Eigen::Vector3d facing = at.normal.isZero(0.0) ? -Eigen::Vector3d::UnitZ()
                                 : at.normal.z() > 0.0 ? Eigen::Vector3d(-at.normal)
                                                       : at.normal;
  contact.normal_world = R_world_frame * facing;
  contact.touched = at.kind;
}

Contact CyberRadar::inflated_contact_of(const Search& search) const {
  Contact contact = nothing_found(search);
  const double free_m = search.overlaps ? 0.0 : std::min(search.best_m, least_unsettled_m(search));
  if (free_m > search.query.distance_m) return contact;
  contact.status = ContactStatus::kContact;
  contact.contact_distance_m = contact.lower_m = free_m;
  return contact;
}

Contact CyberRadar::overlap_of(const Search& search) {
  Contact contact = nothing_found(search);
  const Overlap overlap = overlap_depth(search.object, front_, scene_, search.overlapped, overlap_);
  contact.status = ContactStatus::kOverlap;
  contact.contact_distance_m = contact.upper_m = -overlap.depth_m;
  contact.lower_m = overlap.is_all ? -overlap.depth_m : -kInfinity<double>;
  touch(search, {overlap.point, overlap.normal, overlap.kind}, contact);
  return contact;
}

Contact CyberRadar::contact_of(Search& search) {
  Contact contact = nothing_found(search);
  contact.lower_m = std::min({search.best_m, least_unsettled_m(search), search.query.distance_m});
  if (!(search.best_m <= search.query.distance_m)) return contact;
  contact.status = ContactStatus::kContact;
  contact.contact_distance_m = contact.upper_m = search.best_m;
  const Eigen::Vector2d middle = patch_.middle(search.best_m, search.equally_m());
  if (!patch_.has_all()) look_over(search, middle);
  touch(search, patch_.nearest(middle, search.best_m, search.equally_m()), contact);
  return contact;
}

/// Finds the piece at this place again if more pieces were found than are stored.
void CyberRadar::look_over(Search& search, const Eigen::Vector2d& place) {
  const SceneBound bound = bound_of(search);
  const auto limit = static_cast<float>(search.best_m + search.equally_m());
  patch_.forget_sums();
  heap_.clear();
  scene_.begin(bound, limit, heap_);
  while (!heap_.empty()) {
    const SceneItem item = heap_.back();
    heap_.pop_back();
    if (!item.is_triangle()) {
      scene_.expand(item, bound, limit, heap_);
      continue;
    }
    const FrameTriangle triangle = scene_.triangle(item);
    Eigen::AlignedBox2d outline;
    for (const Eigen::Vector3d& corner : triangle.corners) outline.extend(corner.head<2>());
    if (outline.contains(place)) test_exactly(search, item, triangle);
  }
}

}  // namespace roomradar
