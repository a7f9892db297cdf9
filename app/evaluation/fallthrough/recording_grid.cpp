// recording_grid.cpp: start positions from the octree, ground truth from the reference, drops by the radar.
#include "app/evaluation/fallthrough/recording_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "app/cli/progress.hpp"
#include "app/media/canvas.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "radar/batch/passes_radar.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

Eigen::AlignedBox3d bounds_of(const Mesh& mesh_world) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3f& vertex : mesh_world.vertices)
    bounds.extend(mesh_world.origin + vertex.cast<double>());
  return bounds;
}

/// Returns true if the whole ball is in space that rays have crossed.
bool is_free(const StaticMap& octree, const Vector3d& middle_world, double radius_m) {
  const int steps = static_cast<int>(std::ceil(radius_m / octree.resolution_m()));  // from the centre
  const double step_m = radius_m / steps;
  for (int x = -steps; x <= steps; ++x)
    for (int y = -steps; y <= steps; ++y)
      for (int z = -steps; z <= steps; ++z) {
        const Vector3d p = step_m * Vector3d(x, y, z);
        if (p.norm() <= (1.0 + 1e-9) * radius_m && octree.occupancy_at(middle_world + p) != Occupancy::kFree)
          return false;
      }
  return true;
}

std::optional<Vector3d> place_to_start(const StaticMap& octree, double x, double y, double top_m,
                                       double bottom_m, double radius_m) {
  for (double z = top_m; z > bottom_m; z -= 0.5 * radius_m)
    if (is_free(octree, {x, y, z}, radius_m)) return Vector3d(x, y, z);
  return std::nullopt;
}

/// Returns true if the frame sees the point: no measured surface is in front of it.
bool is_seen(const Frame& frame, const Eigen::Isometry3d& T_world_camera, const Vector3d& p_world) {
  constexpr double kSame_m = 0.05;
  const Vector3d p_camera = T_world_camera.inverse() * p_world;
  if (p_camera.z() <= 0.0) return false;
  const Eigen::Vector2d uv = project(frame.depth_camera, p_camera);
  const int x = static_cast<int>(std::lround(std::clamp(uv.x(), -1.0, 1e6)));
  const int y = static_cast<int>(std::lround(std::clamp(uv.y(), -1.0, 1e6)));
  if (!frame.depth_m.contains(x, y)) return false;
  const float depth_m = frame.depth_m.at(x, y);
  return depth_m > 0.0F && depth_m > p_camera.z() - kSame_m;
}

/// Surfaces that an object can touch, per policy. The surfaces refer to the scenes.
struct PolicyScenes {
  std::vector<std::unique_ptr<FrameScene>> scenes;
  std::array<std::vector<SceneTree>, kPolicyCount> surfaces;
};

/// Meshes the frame under each policy. Room and unknown space must outlive the scenes.
PolicyScenes scenes_of(GlContext& context, const Shape& room, const TriangleTree& unknown, const Frame& frame,
                       const Eigen::Isometry3d& T_world_camera) {
  PolicyScenes made;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const FallthroughPolicy& policy = kFallthroughPolicies[i];
    made.scenes.push_back(std::make_unique<FrameScene>(context, room,
                                                       FrameSceneConfig{.surfaces = policy.surfaces},
                                                       policy.unknown_solid ? &unknown : nullptr));
    FrameScene& scene = *made.scenes[i];
    if (policy.surfaces == SurfacePolicy::kMap) {
      const ExpectedView& expected = scene.render_expected(frame.depth_camera, T_world_camera);
      scene.find_dynamic(frame, expected);  // the foreground's history is one frame
      scene.mesh_surfaces(frame, T_world_camera, expected, scene.find_dynamic(frame, expected));
    } else {
      scene.mesh_all_pixels(frame, T_world_camera);
    }
    made.surfaces[i] = scene.surfaces();
  }
  return made;
}

Rgb plan_colour_of(SurfaceKind touched) {
  switch (touched) {
    case SurfaceKind::kStatic:
      return {120, 190, 130};
    case SurfaceKind::kDynamic:
      return {110, 150, 235};
    case SurfaceKind::kUnknownFrontier:
      return {240, 190, 90};
    case SurfaceKind::kNothing:
      return {214, 40, 40};
    default:
      return {180, 110, 210};
  }
}

Outcome outcome_of(const GridCell& cell, std::size_t policy) {
  Scenario scenario;
  scenario.true_travel_m = cell.true_travel_m;
  return judge(scenario, cell.drops[policy].travelled_m).outcome;
}

}  // namespace

Grid drop_over_grid(GlContext& context, const SavedMap& map, const Frame& frame,
                    const Eigen::Isometry3d& T_world_camera, const Mesh& reference_world,
                    const GridConfig& config) {
  Shape room(context);
  room.set(map.mesh, MeshUsage::kStatic);
  TriangleTree unknown, reference, ball;
  unknown.build_by_place(unknown_surface(map.octree.load(), map.mesh).mesh_world);
  reference.build_by_place(reference_world);
  Mesh ball_mesh;
  append_mesh(sphere(Vector3d::Zero(), config.radius_m), {}, kMeshDeviation_m, ball_mesh);
  ball.build_by_place(ball_mesh);

  const PolicyScenes scenes = scenes_of(context, room, unknown, frame, T_world_camera);

  const Eigen::AlignedBox3d bounds = bounds_of(map.mesh);
  Grid grid;
  grid.config = config;
  grid.columns = static_cast<int>(std::ceil(bounds.sizes().x() / config.cell_m));
  grid.rows = static_cast<int>(std::ceil(bounds.sizes().y() / config.cell_m));
  const double lowest_m = bounds.min().z() - config.below_m;
  CyberRadar exact;
  const std::unique_ptr<Radar> radar = make_radar({.mode = config.radar}, context);
  const SceneTree truth{{&reference, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
  Progress progress("drops", static_cast<std::int64_t>(grid.columns) * grid.rows);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      progress.step();
      const std::optional<Vector3d> start_world =
          place_to_start(map.octree.load(), bounds.min().x() + (column + 0.5) * config.cell_m,
                         bounds.min().y() + (row + 0.5) * config.cell_m, T_world_camera.translation().z(),
                         bounds.min().z(), config.radius_m);
      if (!start_world) continue;
      GridCell cell{column, row, *start_world, false, 0.0, true, {}};
      Eigen::Isometry3d T_world_ball = Eigen::Isometry3d::Identity();
      T_world_ball.translation() = *start_world;
      const double limit_m = start_world->z() - lowest_m;
      const RadarQuery query{{&ball, T_world_ball}, -Vector3d::UnitZ(), limit_m};
      if (const Contact contact = exact.query(query, {{&truth, 1}, {}})) {
        cell.has_truth = contact.contact_distance_m >= 0.0;  // < 0: the ball starts inside the reference
        cell.true_travel_m = contact.contact_distance_m;
        cell.is_hidden = !is_seen(frame, T_world_camera, contact.point_world);
      }
      for (std::size_t i = 0; i < kPolicyCount; ++i) {
        const Contact contact = radar->query(query, {scenes.surfaces[i], {}});
        cell.drops[i] = contact ? GridDrop{std::max(0.0, contact.lower_m), contact.touched}
                                : GridDrop{limit_m, SurfaceKind::kNothing};
      }
      grid.cells.push_back(cell);
    }
  return grid;
}

GridTotals totals_of(const Grid& grid, std::size_t policy, bool hidden_only) {
  GridTotals totals;
  for (const GridCell& cell : grid.cells) {
    if (!cell.has_truth || (hidden_only && !cell.is_hidden)) continue;
    ++totals.cells;
    const Outcome outcome = outcome_of(cell, policy);
    totals.passed += outcome == Outcome::kPassedThrough;
    const SurfaceKind rested_on = cell.drops[policy].rested_on;
    totals.false_stops += outcome == Outcome::kStoppedFalse;
    totals.false_stops_at_unknown +=
        outcome == Outcome::kStoppedFalse && rested_on == SurfaceKind::kUnknownFrontier;
    ++totals.rested_on.at(static_cast<std::size_t>(rested_on));
  }
  return totals;
}

std::string table_of(const Grid& grid) {
  std::string table =
      "surfaces     cells hidden now: number, passed, stopped before   all cells: number, passed, stopped "
      "before, of these at unknown space   rest on\n";
  char line[200];
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const GridTotals hidden = totals_of(grid, i, true), all = totals_of(grid, i, false);
    format_classic(line, sizeof line, "%-12s %23d %8d %8d %27d %8d %8d %24d   ",
                   std::string(kFallthroughPolicies[i].name).c_str(), hidden.cells, hidden.passed,
                   hidden.false_stops, all.cells, all.passed, all.false_stops, all.false_stops_at_unknown);
    table += line;
    for (std::size_t kind = 0; kind < all.rested_on.size(); ++kind) {
      if (all.rested_on[kind] == 0) continue;
      table += " " + std::string(to_string(static_cast<SurfaceKind>(kind))) + " " +
               std::to_string(all.rested_on[kind]);
    }
    table += '\n';
  }
  return table;
}

ColourImage draw_plan(const Grid& grid) {
  constexpr int kSquare_px = 6, kMargin_px = 16, kTitle_px = 26, kLegend_px = 46, kLegendWidth_px = 700;
  const int panel_px = grid.columns * kSquare_px + kMargin_px;
  ColourImage picture(std::max(kLegendWidth_px, panel_px * static_cast<int>(kPolicyCount) + kMargin_px),
                      grid.rows * kSquare_px + kTitle_px + kLegend_px + kMargin_px, Rgb{250, 249, 246});
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const int left = kMargin_px + static_cast<int>(i) * panel_px;
    draw_text(picture, std::string(kFallthroughPolicies[i].name), left, 18, 0.5, {30, 30, 30});
    for (const GridCell& cell : grid.cells) {
      const int x0 = left + cell.column * kSquare_px;
      const int y0 = kTitle_px + (grid.rows - 1 - cell.row) * kSquare_px;
      const bool passed = cell.has_truth && outcome_of(cell, i) == Outcome::kPassedThrough;
      for (int y = 0; y < kSquare_px; ++y)
        for (int x = 0; x < kSquare_px; ++x) {
          const bool rim = x == 0 || y == 0 || x == kSquare_px - 1 || y == kSquare_px - 1;
          blend(picture, x0 + x, y0 + y,
                rim && passed ? Rgb{120, 0, 0} : plan_colour_of(cell.drops[i].rested_on),
                cell.is_hidden || (rim && passed) ? 1.0 : 0.45);
        }
    }
  }
  int x = kMargin_px;
  const int y = picture.height - 34;
  for (const SurfaceKind kind : {SurfaceKind::kStatic, SurfaceKind::kDynamic, SurfaceKind::kInferredBack,
                                 SurfaceKind::kUnknownFrontier, SurfaceKind::kNothing}) {
    for (int dy = 0; dy < 12; ++dy)
      for (int dx = 0; dx < 12; ++dx) blend(picture, x + dx, y - 10 + dy, plan_colour_of(kind));
    const std::string name = kind == SurfaceKind::kNothing ? "fell" : std::string(to_string(kind));
    draw_text(picture, name, x + 18, y, 0.45, {30, 30, 30});
    x += 30 + 9 * static_cast<int>(name.size());
  }
  draw_text(picture, "pale: in view now; dark rim: went through the reference", kMargin_px, y + 20, 0.45,
            {30, 30, 30});
  return picture;
}

}  // namespace roomradar
