// overlap_depth.cpp: step back from span to span until none holds.
#include "radar/overlap_depth.hpp"

namespace roomradar {
namespace {

/// Where one scene triangle is crossed or inside at travel `at_m` (0: by more than touching_m), how far back
/// that lasts; at_m if it is not.
double free_below(const TurnedTree& object, const FrameTriangle& scene, double at_m, OverlapScratch& scratch,
                  Eigen::Vector3d& point) {
  const double touching_m = object.touching_m;
  scratch.spans.clear();
  bool crosses_now = false;
  search_column(
      object, scene, [&] { return at_m + touching_m; }, -std::numeric_limits<double>::infinity(),
      scratch.pending,
      [&](std::uint32_t i) {
        const FrameTriangle o = turned_triangle(object, i);
        TriangleGap gap;
        if (!find_gap(o, scene, gap)) return;
        const TriangleGap::Place& p = gap.places[gap.lowest];
        scratch.spans.push_back({gap.low_m, gap.high_m, {p.x, p.y, p.scene_z}});
        if (at_m == 0.0) {
          crosses_now = crosses_now || meeting_of(o, scene, gap, touching_m) == Meeting::kCrossing;
        } else {
          crosses_now = crosses_now || (gap.low_m < at_m - touching_m && gap.high_m >= at_m - 1e-9);
        }
      });
  // Layers over a point of the triangle tell what is inside between the spans.
  bool knows_inside = false;
  if (object.tree->is_closed()) {
    for (int which = 0; which < 5 && !knows_inside; ++which) {
      knows_inside =
          layers_at(object, inner_point(scene, which), at_m + touching_m, scratch.pending, scratch.layers);
    }
  }
  const auto is_inside_at = [&](double travel_m) {
    return knows_inside && is_within(scratch.layers, travel_m);
  };
  if (!crosses_now) {
    if (at_m == 0.0) {
      std::vector<Layer>& layers = scratch.layers;
      if (!is_inside(object, scene, scratch.pending, layers)) return at_m;
      knows_inside = false;
      for (int which = 0; which < 5 && !knows_inside; ++which)
        knows_inside = layers_at(object, inner_point(scene, which), touching_m, scratch.pending, layers);
    } else if (!is_inside_at(at_m)) {
      return at_m;
    }
  }
  double free_m = at_m;
  while (true) {
    const OverlapScratch::Span* lowest = nullptr;
    const OverlapScratch::Span* next_below = nullptr;
    for (const OverlapScratch::Span& span : scratch.spans) {
      if (span.low_m >= free_m) continue;
      if (span.high_m >= free_m - 1e-9) {
        if (lowest == nullptr || span.low_m < lowest->low_m) lowest = &span;
      } else if (next_below == nullptr || span.high_m > next_below->high_m) {
        next_below = &span;
      }
    }
    if (lowest != nullptr) {
      free_m = lowest->low_m;
      point = lowest->point;
    } else if (next_below != nullptr && is_inside_at(free_m - 1e-9)) {
      free_m = next_below->high_m;
    } else {
      return free_m;
    }
  }
}

}  // namespace

Overlap overlap_depth(const TurnedTree& object, const FrontMap& front, SceneInFrame& scene,
                      OverlapScratch& scratch) {
  Overlap result;
  double free_m = 0.0;
  const double deepest_m = -1e3 * (1e-3 + front.bounds().sizes().norm());  // a scene without end
  for (double before_m = 1.0; before_m > free_m && free_m > deepest_m;) {
    before_m = free_m;
    Eigen::AlignedBox3d volume = front.bounds();
    volume.min().z() += before_m;
    volume.max().z() += before_m;
    const SceneBound bound{&front, static_cast<float>(volume.min().z() - object.touching_m)};
    const double touching_m = object.touching_m;
    const auto limit = [&] { return static_cast<float>(std::min(free_m, before_m) + touching_m); };
    scratch.items.clear();
    scene.begin(volume, bound, limit(), scratch.items);
    // What may reach back farthest first: it rules out most of the rest.
    const auto is_farther = [](const SceneItem& a, const SceneItem& b) { return a.low_m > b.low_m; };
    std::make_heap(scratch.items.begin(), scratch.items.end(), is_farther);
    while (!scratch.items.empty()) {
      std::pop_heap(scratch.items.begin(), scratch.items.end(), is_farther);
      const SceneItem item = scratch.items.back();
      scratch.items.pop_back();
      if (!(item.low_m < limit())) break;
      if (item.kind != SceneItem::Kind::kTriangle) {
        const std::size_t before = scratch.items.size();
        scene.expand(item, bound, limit(), scratch.items);
        for (std::size_t i = before; i < scratch.items.size(); ++i) {
          std::push_heap(scratch.items.begin(), scratch.items.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                         is_farther);
        }
        continue;
      }
      const FrameTriangle triangle = scene.triangle(item);
      if (triangle.normal.z() > kEdgeOn) continue;
      Eigen::Vector3d point = inner_point(triangle, 0);
      const double end_m = free_below(object, triangle, before_m, scratch, point);
      if (!(end_m < free_m)) continue;
      free_m = end_m;
      result = {-free_m, point, triangle.normal, scene.kind(item)};
    }
  }
  return result;
}

}  // namespace roomradar
