// live_model_view.cpp: meshes of the model's parts, and lines over them.
#include "app/window/scan/live_model_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "app/session/picture_composer.hpp"

namespace roomradar {
namespace {

constexpr ImU32 kPath = IM_COL32(64, 196, 172, 150);

void draw_path(ImDrawList& list, const ShownScan& shown, const ToWindow& to_window) {
  std::optional<ImVec2> last;
  for (const Eigen::Vector3f& position : shown.path_world) {
    const std::optional<ImVec2> at = to_window(position.cast<double>());
    if (at && last) list.AddLine(*last, *at, kPath, look::px(1.5F));
    last = at;
  }
}

/// Draws a disc with its number at each hole, the largest hole on top.
void draw_holes(ImDrawList& list, std::span<const NumberedHole> holes, const ToWindow& to_window,
                const look::Fonts& fonts) {
  for (auto hole = holes.rbegin(); hole != holes.rend(); ++hole) {
    const std::optional<ImVec2> at = to_window(hole->hole.position_world);
    if (!at) continue;
    const std::string number = std::to_string(hole->number);
    const ImVec2 size = fonts.small->CalcTextSizeA(fonts.small->FontSize, 1e4F, 0.0F, number.c_str());
    const float radius = 0.5F * std::max(size.x, size.y) + look::px(3.0F);
    list.AddCircleFilled(*at, radius, IM_COL32(16, 19, 24, 220));
    list.AddCircle(*at, radius, look::kWarn, 0, look::px(1.5F));
    list.AddText(fonts.small, fonts.small->FontSize, {at->x - 0.5F * size.x, at->y - 0.5F * size.y},
                 look::kWarn, number.c_str());
  }
}

}  // namespace

void LiveModelView::upload(const ShownScan& shown) {
  std::set<std::shared_ptr<const Mesh>> present;
  for (const ShownPart& part : shown.parts) {
    present.insert(part.mesh);
    auto& drawn = drawn_[part.mesh];
    if (drawn) continue;
    drawn = std::make_unique<DrawnMesh>();
    drawn->upload(*part.mesh, /*changes_often=*/false);
  }
  std::erase_if(drawn_, [&](const auto& drawn) { return !present.contains(drawn.first); });
  canvas_.content_changed();
}

/// Moves the eye smoothly to a place behind and above the camera.
void LiveModelView::follow(const ShownScan& shown) {
  constexpr double kAhead_m = 1.2, kDistance_m = 3.2, kElevation_rad = 0.6, kSmoothed_s = 0.2;
  const Eigen::Vector3d ahead = shown.T_world_camera.linear().col(2);
  const Eigen::Vector3d target = shown.T_world_camera.translation() + kAhead_m * ahead;
  const double azimuth_rad = std::atan2(-ahead.y(), -ahead.x());
  Orbit& orbit = canvas_.orbit;
  const double now_s = ImGui::GetTime();
  const double share = 1.0 - std::exp((std::exchange(followed_s_, now_s) - now_s) / kSmoothed_s);
  orbit.target_world += share * (target - orbit.target_world);
  orbit.azimuth_rad += share * std::remainder(azimuth_rad - orbit.azimuth_rad, 2.0 * std::numbers::pi);
  orbit.elevation_rad += share * (kElevation_rad - orbit.elevation_rad);
  orbit.distance_m += share * (kDistance_m - orbit.distance_m);
}

void LiveModelView::look_at(const Mesh& mesh) {
  const Eigen::AlignedBox3d box = bounds_of(mesh);
  if (box.isEmpty()) return;
  follows_ = false;
  canvas_.orbit.target_world = box.center();
  canvas_.orbit.elevation_rad = 0.8;
  canvas_.orbit.distance_m = std::clamp(1.1 * box.diagonal().norm(), 1.0, 30.0);
  canvas_.orbit_changed();
}

void LiveModelView::draw(const Area& area, const ShownScan& shown, const look::Fonts& fonts) {
  look::begin_pane("live model", area, look::kGround);
  ImGui::SetCursorScreenPos({area.x, area.y});
  ImGui::InvisibleButton("orbit", {area.width, area.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  if (canvas_.steer(area)) follows_ = follows_ && !ImGui::IsItemActive();
  if (canvas_.must_render(static_cast<int>(area.width), static_cast<int>(area.height))) {
    if (follows_) follow(shown);
    canvas_.begin();
    for (const ShownPart& part : shown.parts)
      canvas_.draw(*drawn_.at(part.mesh), part.T_world_mesh, {{0.62F, 0.66F, 0.72F}, 0.1F},
                   /*is_transparent_behind=*/true);
    canvas_.end();
  }
  canvas_.show(area);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ToWindow to_window = canvas_.to_window(area);
  draw_path(list, shown, to_window);
  if (shown.next_view) {
    draw_camera(list, {shown.camera, shown.next_view->T_world_camera}, 0.25, to_window);
    const std::optional<ImVec2> from = to_window(shown.T_world_camera.translation()),
                                to = to_window(shown.next_view->T_world_camera * Eigen::Vector3d(0, 0, 0.25));
    if (from && to) list.AddLine(*from, *to, look::kWarn, look::px(2.0F));
  }
  draw_holes(list, shown.holes, to_window, fonts);
  if (shown.frame_index >= 0) draw_camera(list, {shown.camera, shown.T_world_camera}, 0.35, to_window);
  if (shown.parts.empty())
    list.AddText(fonts.text, fonts.text->FontSize, {area.x + look::px(16.0F), area.y + look::px(16.0F)},
                 look::kDim, "the model appears here");
  look::end_pane();
}

}  // namespace roomradar
