// trial_pictures.cpp: sections from signed distances, and from triangles that cross the plane.
#include "app/evaluation/fallthrough/trial_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/media/canvas.hpp"
#include "app/media/video_writer.hpp"
#include "app/render/compose.hpp"

namespace roomradar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Rgb view_colour_of(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kStatic:
      return {20, 20, 24};
    case SurfaceKind::kDynamic:
      return {30, 90, 230};
    case SurfaceKind::kUnknownFrontier:
      return {230, 60, 60};
    default:
      return {150, 60, 200};
  }
}

constexpr int kPanel_px = 320, kColumns = 3, kRows = 2;
static_assert(kPolicyCount + 1 <= static_cast<std::size_t>(kColumns * kRows));

/// Content of a policy's panel, frame by frame.
struct Panel {
  struct Step {
    ColourImage section;
    double from_m, to_m;
  };
  std::vector<Step> steps;
  Trial trial;
};

}  // namespace

SideView::SideView(const Scenario& scenario, const Room& room, int width_px, int height_px)
    : scenario_(scenario), room_(width_px, height_px, Rgb{250, 249, 246}), object_(width_px, height_px, 0) {
  const Vector3d& way = scenario.direction_world;
  const Vector3d to_camera = scenario.T_world_camera.translation() - scenario.contact_world;
  // Up in the picture is the projection of world up onto the section, or if the section is level, the
  // object's backward direction.
  Vector3d across = way.cross(to_camera);
  if (across.norm() < 1e-3 * to_camera.norm()) across = way.unitOrthogonal();
  across.normalize();
  Vector3d up = Vector3d::UnitZ() - across * across.z();
  if (up.norm() < 0.1) up = -way - across * across.dot(-way);
  up_world_ = up.normalized();
  right_world_ = up_world_.cross(across);
  const Vector3d start = scenario.T_world_object.translation();
  const Vector3d end = start + scenario.limit_m * way;
  middle_world_ = scenario.contact_world;
  for (const Vector3d& axis : {right_world_, up_world_})
    middle_world_ += axis * axis.dot(0.5 * (start + end) - scenario.contact_world);
  const double half_m = 0.5 * scenario.limit_m + scenario.object.reach_m + 0.08;
  m_per_px_ = 2.0 * half_m / std::min(width_px, height_px);
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) {
      const Vector3d p_world = world_at(x, y);
      if (signed_distance_m(room, p_world) <= 0.0) room_.at(x, y) = {196, 193, 186};
      const Vector3d p_object = scenario.T_world_object.inverse() * p_world;
      if (p_object.norm() > scenario.object.reach_m) continue;
      for (const Solid& part : scenario.object.parts)
        if (signed_distance_m(part, p_object) <= 0.5 * m_per_px_) object_.at(x, y) = 255;
    }
}

Vector3d SideView::world_at(double x, double y) const {
  return middle_world_ +
         m_per_px_ * ((x - 0.5 * room_.width) * right_world_ - (y - 0.5 * room_.height) * up_world_);
}

Vector2d SideView::pixel_of(const Vector3d& p_world) const {
  const Vector3d from_middle = (p_world - middle_world_) / m_per_px_;
  return {0.5 * room_.width + right_world_.dot(from_middle), 0.5 * room_.height - up_world_.dot(from_middle)};
}

ColourImage SideView::room_at(int frame) const {
  ColourImage picture = room_;
  const std::vector<Solid> occluder = occluder_at(scenario_, frame);
  if (occluder.empty()) return picture;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Vector3d p_world = world_at(x, y);
      for (const Solid& solid : occluder)
        if (signed_distance_m(solid, p_world) <= 0.0) picture.at(x, y) = {240, 176, 96};
    }
  return picture;
}

void SideView::add_surfaces(std::span<const SceneTree> surfaces, ColourImage& picture) const {
  const Vector3d across = right_world_.cross(up_world_);
  for (const SceneTree& surface : surfaces) {
    const TriangleTree& tree = *surface.instance.tree;
    if (tree.empty()) continue;
    std::vector<Vector3d> corners;
    std::vector<double> sides_m;
    for (const Eigen::Vector3f& vertex : tree.vertices()) {
      corners.push_back(surface.instance.T_world_mesh * (tree.origin() + vertex.cast<double>()));
      sides_m.push_back(across.dot(corners.back() - middle_world_));
    }
    for (const Triangle& t : tree.triangles()) {
      std::array<Vector2d, 2> ends;
      std::size_t found = 0;
      for (std::size_t i = 0; i < 3 && found < 2; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if ((sides_m[a] < 0.0) == (sides_m[b] < 0.0)) continue;
        ends[found++] =
            pixel_of(corners[a] + (corners[b] - corners[a]) * (sides_m[a] / (sides_m[a] - sides_m[b])));
      }
      if (found == 2) draw_line(picture, ends[0], ends[1], view_colour_of(surface.kind), 1);
    }
  }
}

void SideView::add_object(double travelled_m, Rgb colour, double part, ColourImage& picture) const {
  const Vector2d shift =
      pixel_of(middle_world_ + travelled_m * scenario_.direction_world) - pixel_of(middle_world_);
  const int dx = static_cast<int>(std::lround(shift.x())), dy = static_cast<int>(std::lround(shift.y()));
  MaskImage moved(object_.width, object_.height, 0);
  for (int y = 0; y < moved.height; ++y)
    for (int x = 0; x < moved.width; ++x)
      if (object_.contains(x - dx, y - dy)) moved.at(x, y) = object_.at(x - dx, y - dy);
  tint(picture, moved, colour, part);
}

ColourImage camera_view(const Scenario& scenario, const Frame& frame, int width_px) {
  ColourImage full;
  shade_depth(frame.depth_m, scenario.depth_camera, full);
  ColourImage picture(width_px, width_px * full.height / full.width);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      picture.at(x, y) = full.at(x * full.width / picture.width, y * full.height / picture.height);
  return picture;
}

void add_outline(const Scenario& scenario, double travelled_m, Rgb colour, double part,
                 ColourImage& picture) {
  constexpr double kNearest_m = 0.05;
  const Intrinsics camera =
      scaled(scenario.depth_camera, static_cast<double>(picture.width) / scenario.depth_camera.width_px);
  const Eigen::Isometry3d T_camera_object =
      scenario.T_world_camera.inverse() *
      (Eigen::Translation3d(travelled_m * scenario.direction_world) * scenario.T_world_object);
  MaskImage mask(picture.width, picture.height, 0);
  for (const Triangle& t : scenario.object_mesh.triangles) {
    std::array<Vector2d, 3> corners;
    bool before_camera = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d p_camera = T_camera_object * scenario.object_mesh.vertices[t[i]].cast<double>();
      before_camera &= p_camera.z() > kNearest_m;
      if (before_camera) corners[i] = project(camera, p_camera);
    }
    if (before_camera) fill_triangle(mask, corners[0], corners[1], corners[2]);
  }
  tint(picture, mask, colour, part);
}

ColourImage picture_of_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy, Radar& radar) {
  constexpr int kCamera_px = 320, kHeight_px = 240;
  const Scenario& scenario = prepared.scenario;
  const SideView side(scenario, room.scanned.simulated.room, kHeight_px, kHeight_px);
  ColourImage section, view;
  const Trial trial = run_trial(prepared, room, policy, radar, [&](const TrialStep& step) {
    if (!step.is_last) return;
    section = side.room_at(step.frame);
    side.add_surfaces(step.surfaces, section);
    view = camera_view(scenario, prepared.frames.at(step.frame), kCamera_px);
  });
  for (const auto& [travelled_m, colour] : {std::pair{0.0, kStartColour},
                                            {scenario.true_travel_m, kTruthColour},
                                            {trial.travelled_m, kEndColour}}) {
    side.add_object(travelled_m, colour, 0.25, section);
    add_outline(scenario, travelled_m, colour, 0.3, view);
  }
  ColourImage both(kCamera_px + kHeight_px, kHeight_px);
  paste(view, 0, 0, both);
  paste(section, kCamera_px, 0, both);
  return both;
}

void write_replay(PreparedScenario& prepared, MappedRoom& room, Radar& radar, VideoWriter& video) {
  constexpr double kShown_s = 4.0;
  const Scenario& scenario = prepared.scenario;
  const SideView side(scenario, room.scanned.simulated.room, kPanel_px, kPanel_px);
  std::array<Panel, kPolicyCount> panels;
  std::size_t most_steps = 1;
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    panels[i].trial = run_trial(prepared, room, i, radar, [&](const TrialStep& step) {
      const bool as_before = !panels[i].steps.empty() && scenario.occluder_velocity_world.isZero();
      ColourImage section = as_before ? panels[i].steps.back().section : side.room_at(step.frame);
      if (!as_before) side.add_surfaces(step.surfaces, section);
      panels[i].steps.push_back({std::move(section), step.from_m, step.to_m});
    });
    most_steps = std::max(most_steps, panels[i].steps.size());
  }
  const int slow =
      std::max(2, static_cast<int>(kReplayPicturesPerS * kShown_s / static_cast<double>(most_steps)));
  ColourImage picture(kColumns * kPanel_px, kRows * kPanel_px);
  const auto show = [&](std::size_t step, double part) {
    picture.resize(picture.width, picture.height, Rgb{255, 255, 255});
    ColourImage view = camera_view(
        scenario, prepared.frames.at(static_cast<int>(std::min(step, most_steps - 1))), kPanel_px);
    add_outline(scenario,
                std::min((static_cast<double>(step) + part) * step_m(scenario), scenario.true_travel_m),
                kTruthColour, 0.3, view);
    paste(view, 0, 40, picture);
    draw_text(picture, "camera; object as in truth", 8, 24, 0.5, {30, 30, 30});
    for (std::size_t i = 0; i < kPolicyCount; ++i) {
      const auto& steps = panels[i].steps;
      const auto& now = steps[std::min(step, steps.size() - 1)];
      const double now_part = step < steps.size() ? part : 1.0;
      ColourImage section = now.section;
      side.add_object(scenario.true_travel_m, kTruthColour, 0.1, section);
      side.add_object(now.from_m + now_part * (now.to_m - now.from_m), kEndColour, 0.4, section);
      std::string title(kFallthroughPolicies[i].name);
      if (step >= steps.size()) title += ": " + std::string(to_string(panels[i].trial.verdict.outcome));
      draw_text(section, title, 8, 20, 0.5, {30, 30, 30});
      const int place = static_cast<int>(i) + 1;
      paste(section, place % kColumns * kPanel_px, place / kColumns * kPanel_px, picture);
    }
    video.write(picture);
  };
  for (std::size_t step = 0; step < most_steps; ++step)
    for (int i = 0; i < slow; ++i) show(step, static_cast<double>(i) / slow);
  for (int i = 0; i < static_cast<int>(kReplayPicturesPerS); ++i) show(most_steps, 1.0);
  video.close();
}

}  // namespace roomradar
