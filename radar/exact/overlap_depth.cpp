// overlap_depth.cpp: steps back from interval to interval until none contains the position.
#include "radar/exact/overlap_depth.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

/// Returns the travel, at most at_m, down to which a scene triangle that the object crosses or contains at
/// travel at_m remains crossed or contained. Returns at_m if it is neither. At 0, crossing counts from
/// touching_m on.
double free_below(const TurnedTree& object, const FrameTriangle& scene, double at_m, OverlapScratch& scratch,
                  Eigen::Vector3d& point) {
  const double touching_m = object.touching_m;
  scratch.spans.clear();
  bool crosses_now = false;
  search_column(
      object, scene, [&] { return at_m + touching_m; }, -std::numeric_limits<double>::infinity(),
      scratch.columns,
      [&](std::uint32_t i) {
        const FrameTriangle o = turned_triangle(object, i);
        TriangleGap gap;
        if (!find_gap(o, scene, gap)) return;
        const TriangleGap::Vertex& p = gap.vertices[gap.lowest];
        scratch.spans.push_back({gap.low_m, gap.high_m, {p.x, p.y, p.scene_z}});
        if (at_m == 0.0) {
          crosses_now = crosses_now || classify_pair(o, scene, gap, touching_m) == PairContact::kCrossing;
        } else {
          crosses_now = crosses_now || (gap.low_m < at_m - touching_m && gap.high_m >= at_m - 1e-9);
        }
      });
  // The crossings above a point of the triangle show which intervals between the spans are inside.
  bool knows_inside = false;
  if (object.tree->is_closed()) {
    for (int which = 0; which < 5 && !knows_inside; ++which) {
      knows_inside =
          layers_at(object, inner_point(scene, which), at_m + touching_m, scratch.columns, scratch.layers);
    }
  }
  const auto is_inside_at = [&](double contact_distance_m) {
    return knows_inside && is_within(scratch.layers, contact_distance_m);
  };
  if (!crosses_now) {
    if (at_m == 0.0) {
      std::vector<Layer>& layers = scratch.layers;
      if (!is_inside(object, scene, scratch.columns, layers)) return at_m;
      knows_inside = false;
      for (int which = 0; which < 5 && !knows_inside; ++which)
        knows_inside = layers_at(object, inner_point(scene, which), touching_m, scratch.columns, layers);
    } else if (!is_inside_at(at_m)) {
      return at_m;
    }
  }
  // Sort by far end: every interval that contains free_m precedes those that do not.
  std::sort(scratch.spans.begin(), scratch.spans.end(),
            [](const auto& a, const auto& b) { return a.high_m > b.high_m; });
  constexpr double kTogether_m = 1e-9;
  double free_m = at_m;
  for (auto span = scratch.spans.begin();;) {
    for (; span != scratch.spans.end() && span->high_m >= free_m - kTogether_m; ++span) {
      if (!(span->low_m < free_m)) continue;
      free_m = span->low_m;
      point = span->point;
    }
    if (span == scratch.spans.end() || !is_inside_at(free_m - kTogether_m)) return free_m;
    free_m = span->high_m;
  }
}

}  // namespace

Overlap overlap_depth(const TurnedTree& object, const ObjectHeightMap& front, SceneInFrame& scene,
                      const OverlappedTriangle& known, OverlapScratch& scratch) {
  Overlap result;
  result.point = inner_point(known.triangle, 0);
  result.normal = known.triangle.normal;
  result.kind = known.kind;
  double free_m = 0.0;
  const auto step_back = [&](const FrameTriangle& triangle, SurfaceKind kind, double from_m) {
    Eigen::Vector3d point = inner_point(triangle, 0);
    const double end_m = free_below(object, triangle, from_m, scratch, point);
    if (!(end_m < free_m)) return;
    free_m = end_m;
    result = {.depth_m = -free_m, .point = point, .normal = triangle.normal, .kind = kind};
  };
  scratch.columns.work = 0;
  double before_m = 0.0;
  do {
    Eigen::AlignedBox3d volume = front.bounds();
    volume.min().z() += before_m;
    volume.max().z() += before_m;
    const SceneBound bound{&front, static_cast<float>(volume.min().z() - object.touching_m)};
    const double touching_m = object.touching_m;
    const auto limit = [&] { return static_cast<float>(std::min(free_m, before_m) + touching_m); };
    scratch.items.clear();
    scene.enter(volume);
    scene.begin(bound, limit(), scratch.items);
    // Items that may reach back farthest come first, because they rule out most of the rest.
    const auto is_farther = [](const SceneItem& a, const SceneItem& b) { return a.low_m > b.low_m; };
    std::make_heap(scratch.items.begin(), scratch.items.end(), is_farther);
    while (!scratch.items.empty()) {
      std::pop_heap(scratch.items.begin(), scratch.items.end(), is_farther);
      const SceneItem item = scratch.items.back();
      scratch.items.pop_back();
      if (!(item.low_m < limit())) break;
      scratch.columns.work += 2;
      if (scratch.columns.work > kMostOverlapWork) {
        if (free_m == 0.0) step_back(known.triangle, known.kind, 0.0);
        result.is_all = false;
        return result;
      }
      if (!item.is_triangle()) {
        const std::size_t before = scratch.items.size();
        scene.expand(item, bound, limit(), scratch.items);
        for (std::size_t i = before; i < scratch.items.size(); ++i) {
          std::push_heap(scratch.items.begin(), scratch.items.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                         is_farther);
        }
        continue;
      }
      const FrameTriangle triangle = scene.triangle(item);
      if (triangle.normal.z() > kEdgeOn || !(bound.low_m(triangle) < limit())) continue;
      step_back(triangle, scene.kind(item), before_m);
    }
  } while (std::exchange(before_m, free_m) > free_m);
  return result;
}

}  // namespace roomradar
