// object_front.cpp: weighs the cost of a finer M against the work that a coarser one left.
#include "radar/exact/object_front.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

/// Returns the cost of building M, in units of ColumnScratch::work; triangles smaller than a pixel are
/// entered together.
std::uint64_t work_to_build(const TurnedTree& object, int px) {
  const auto pixels = static_cast<std::uint64_t>(px) * static_cast<std::uint64_t>(px);
  return std::min<std::uint64_t>(object.tree->triangle_count() / 2, pixels) + pixels / 50;
}

/// Returns the resolution of M for a new direction. A finer M pays if there is more scene to rule out: it
/// takes more time, but leaves fewer pairs for exact tests.
int fresh_px(const SceneInFrame& scene) {
  constexpr int kLeast_px = 8, kMost_px = 40, kOverTrees_px = 24;
  if (scene.has_trees()) return kOverTrees_px;
  const double px = 2.5 * std::sqrt(std::sqrt(static_cast<double>(scene.cell_count())));
  return std::clamp(static_cast<int>(px), kLeast_px, kMost_px);
}

}  // namespace

Eigen::Vector3d ObjectFront::direction_in_object(const RadarQuery& query) {
  const Eigen::Vector3d u_mesh =
      (query.object.T_world_mesh.linear().transpose() * query.direction_world.stableNormalized())
          .normalized();
  if (!((u_mesh - u_mesh_).squaredNorm() < 1e-26)) u_mesh_ = u_mesh;
  return u_mesh_;
}

void ObjectFront::turn(const TurnedTree& object) {
  is_kept_ = map_.holds(object);
  map_.turn(object);
}

void ObjectFront::build(const TurnedTree& object, const SceneInFrame& scene, const RadarConfig& config) {
  constexpr int kFewFresh_px = 64;
  constexpr int kFinest_px = 384;  // unless config.resolution_px is finer
  const std::array kept_px{96, 192, kFinest_px, std::max(kFinest_px, config.resolution_px)};
  constexpr std::size_t kFewTriangles = 500;  // fewer make a cheap M
  const bool is_exact = config.mode != RadarMode::kSampled;
  const auto at_most_asked = [&](int px) {
    return is_exact ? std::min(px, kFinest_px) : std::min(px, config.resolution_px);
  };
  if (!is_kept_) {
    work_ = 0;
    const bool has_few = object.tree->triangle_count() < kFewTriangles;
    map_.build(object, at_most_asked(has_few ? kFewFresh_px : fresh_px(scene)));
    return;
  }
  int finest_px = 0;
  for (const int px : kept_px)
    if (2 * work_ > work_to_build(object, at_most_asked(px))) finest_px = at_most_asked(px);
  if (finest_px > 0) map_.build(object, finest_px);
}

}  // namespace roomradar
