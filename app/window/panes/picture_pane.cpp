// picture_pane.cpp: shows the picture, marks the chosen object, and turns mouse actions into commands.
#include "app/window/panes/panes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/window/link/player.hpp"
#include "app/window/panes/annotate.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr double kDragFrom_px = 4.0;  // pixels of the window; a shorter drag is a click
constexpr double kWheel_m = 0.04;

/// Draws the position under the mouse below the frame's number, because messages cover the bottom.
void draw_position(ImDrawList& draw, const Area& image, const Eigen::Vector3d& p_world,
                   const look::Fonts& fonts) {
  const float margin = look::px(10.0F);
  const std::string position = position_words(p_world) + " m", advised = position + "   (Ctrl+C copies)";
  const float wide = fonts.small->CalcTextSizeA(fonts.small->FontSize, 1e4F, 0.0F, advised.c_str()).x;
  look::note(draw, {image.x + margin, image.y + look::px(26.0F)},
             wide + 2.0F * margin > image.width ? position : advised, look::kText, fonts);
}

}  // namespace

std::string position_words(const Eigen::Vector3d& p_world) {
  std::array<char, 80> text{};
  format_classic(text.data(), text.size(), "%.3f %.3f %.3f", p_world.x(), p_world.y(), p_world.z());
  return text.data();
}

void PicturePane::draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts,
                       double drop_height_m) {
  look::begin_pane("picture", area, look::kGround);
  const Area image = fitted(area, texture_.width(), texture_.height());
  pixel_.reset();
  if (!image.empty()) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddImage(texture_.id(), {image.x, image.y}, {image.x + image.width, image.y + image.height});
    const double scale = image.width / static_cast<double>(texture_.width());
    ImGui::SetCursorScreenPos({image.x, image.y});
    ImGui::InvisibleButton("mouse", {image.width, image.height},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImVec2 mouse = ImGui::GetMousePos();
    const Eigen::Vector2d pixel((mouse.x - image.x) / scale - 0.5, (mouse.y - image.y) / scale - 0.5);
    const bool is_here = ImGui::IsItemHovered() || ImGui::IsItemActive();
    if (is_here) pixel_ = pixel;
    if (is_here || is_down_)
      press_and_drag(pixel, drop_height_m);  // a grabbed object may be released
                                             // elsewhere
    if (is_here) turn(shown);
    mark_chosen(*draw, shown, image, scale, fonts);
    std::array<char, 96> text{};
    format_classic(text.data(), text.size(), "frame %lld   %.1f s",
                   static_cast<long long>(shown.source_frame), shown.run_time_s);
    look::note(*draw, {image.x + look::px(10.0F), image.y + look::px(8.0F)}, text.data(), look::kText, fonts);
    if (is_here && shown.pointed_world) draw_position(*draw, image, *shown.pointed_world, fonts);
  }
  look::end_pane();
}

void PicturePane::leave() {
  pixel_.reset();
  if (!is_down_) return;
  is_down_ = false;
  link_.ask(LetGo{.pixel = lately_.back().pixel, .was_dragged = true, .nearer_m = nearer_m_});
}

void PicturePane::press_and_drag(const Eigen::Vector2d& pixel, double drop_height_m) {
  const ImVec2 mouse = ImGui::GetMousePos();
  const Eigen::Vector2d at(mouse.x, mouse.y);
  const double now_s = ImGui::GetTime();
  if (ImGui::IsItemActive() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    is_down_ = true;
    was_dragged_ = ImGui::GetIO().KeyShift;  // Shift + click places at once
    pressed_at_ = at;
    nearer_m_ = 0.0;
    lately_.fill({now_s, pixel});
    if (ImGui::GetIO().KeyShift)
      link_.ask(PlaceChosen{pixel});
    else
      link_.ask(GrabObject{pixel});
    return;
  }
  if (!is_down_) return;
  if (now_s - lately_.back().time_s > 0.01) {
    std::rotate(lately_.begin(), lately_.begin() + 1, lately_.end());
    lately_.back() = {now_s, pixel};
  }
  const float wheel = ImGui::GetIO().MouseWheel;
  nearer_m_ -= kWheel_m * static_cast<double>(wheel);
  const bool moved = (at - pressed_at_).norm() > kDragFrom_px || wheel != 0.0F;
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    was_dragged_ = was_dragged_ || moved;
    if (!was_dragged_ || ImGui::GetIO().KeyShift) return;
    const ImVec2 way = ImGui::GetIO().MouseDelta;
    if (way.x == 0.0F && way.y == 0.0F && wheel == 0.0F) return;
    link_.ask(DragGrabbed{pixel, nearer_m_});
  } else {
    is_down_ = false;
    link_.ask(LetGo{pixel, velocity_px_s(), was_dragged_, nearer_m_, drop_height_m});
  }
}

Eigen::Vector2d PicturePane::velocity_px_s() const {
  constexpr double kLately_s = 0.12;
  const double now_s = ImGui::GetTime();
  for (const Sample& sample : lately_) {
    if (now_s - sample.time_s > kLately_s) continue;
    const double dt_s = lately_.back().time_s - sample.time_s;
    // A mouse that rested before the release does not throw.
    if (dt_s < 0.015 || now_s - lately_.back().time_s > 0.06) break;
    return (lately_.back().pixel - sample.pixel) / dt_s;
  }
  return Eigen::Vector2d::Zero();
}

void PicturePane::turn(const Snapshot& shown) {
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Right) || !shown.view) return;
  const ImVec2 way = ImGui::GetIO().MouseDelta;
  if (way.x == 0.0F && way.y == 0.0F) return;
  link_.ask(
      TurnGrabbed{turn_of_drag_world_deg(shown.view->T_world_view.linear(), Eigen::Vector2d(way.x, way.y))});
}

}  // namespace roomradar
