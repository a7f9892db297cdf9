// annotate.cpp: projects and draws the marks.
#include "app/window/panes/annotate.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "app/objects/unknown_support.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

void draw_line(ImDrawList& draw, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               const ToWindow& to_window, ImU32 colour, float thickness) {
  const auto from = to_window(a), to = to_window(b);
  if (from && to) draw.AddLine(*from, *to, colour, thickness);
}

/// Draws a text on a dark ground. If `at` lies within the clip rectangle, the whole label is moved into it.
void draw_label(ImDrawList& draw, ImVec2 at, const std::string& text, ImU32 colour,
                const look::Fonts& fonts) {
  ImGui::PushFont(fonts.small);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImGui::PopFont();
  const float beside = look::px(5.0F), above = look::px(3.0F);
  const ImVec2 low = draw.GetClipRectMin(), high = draw.GetClipRectMax();
  const bool is_in_view =
      at.x + size.x >= low.x && at.x <= high.x && at.y + size.y >= low.y && at.y <= high.y;
  if (is_in_view)
    at = {shifted_inside(at.x, size.x, low.x + beside, high.x - beside),
          shifted_inside(at.y, size.y, low.y + above, high.y - above)};
  look::note(draw, at, text, colour, fonts);
}

/// Draws the twelve edges of a box. `corner(i)` returns corner i, for which bits 0, 1 and 2 of i select min
/// or max of x, y and z.
void draw_box(ImDrawList& draw, const std::function<Eigen::Vector3d(int)>& corner, const ToWindow& to_window,
              ImU32 colour, float thickness) {
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4})
      if ((i & bit) == 0) draw_line(draw, corner(i), corner(i | bit), to_window, colour, thickness);
}

}  // namespace

std::string what_it_does(const ShownObject& object) {
  if (!object.in_room) return "not in the room";
  if (object.is_carried) return "carried";
  if (object.stuck) return "stuck in a surface";
  if (object.asleep) return "at rest" + std::string(support_words(object.rests_on));
  std::array<char, 32> text{};
  format_classic(text.data(), text.size(), "moves at %.1f m/s", object.velocity_world_mps.norm());
  return text.data();
}

void mark_chosen(ImDrawList& draw, const Snapshot& shown, const Area& image, double scale,
                 const look::Fonts& fonts) {
  const auto found = std::find_if(shown.objects.begin(), shown.objects.end(), [&](const ShownObject& object) {
    return object.in_room && object.name == shown.chosen;
  });
  if (found == shown.objects.end() || !shown.view) return;
  ImVec2 low{1e9F, 1e9F}, high{-1e9F, -1e9F};
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = found->box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    const Eigen::Vector3d p = shown.view->T_world_view.inverse() * (found->T_world_object * corner);
    if (p.z() < 0.05) return;
    const Eigen::Vector2d pixel = scale * (project(shown.view->camera, p) + Eigen::Vector2d(0.5, 0.5));
    low = {std::min(low.x, static_cast<float>(pixel.x())), std::min(low.y, static_cast<float>(pixel.y()))};
    high = {std::max(high.x, static_cast<float>(pixel.x())), std::max(high.y, static_cast<float>(pixel.y()))};
  }
  const float gap = look::px(6.0F);
  const float left = image.x + low.x - gap, top = image.y + low.y - gap;
  const float right = image.x + high.x + gap, bottom = image.y + high.y + gap;
  const float leg = std::clamp(0.22F * std::min(right - left, bottom - top), look::px(6.0F), look::px(18.0F));
  const ImU32 colour = found->is_carried ? look::kWarn : look::kAccent;
  draw.PushClipRect({image.x, image.y}, {image.x + image.width, image.y + image.height}, true);
  for (const float x : {left, right}) {
    for (const float y : {top, bottom}) {
      draw.AddLine({x, y}, {x + (x == left ? leg : -leg), y}, colour, look::px(2.0F));
      draw.AddLine({x, y}, {x, y + (y == top ? leg : -leg)}, colour, look::px(2.0F));
    }
  }
  draw_label(draw, {left + look::px(5.0F), bottom + look::px(7.0F)},
             found->name + ": " + what_it_does(*found), look::kText, fonts);
  draw.PopClipRect();
}

void draw_target_volume(ImDrawList& draw, const ShownRadar& radar, const ToWindow& to_window,
                        const look::Fonts& fonts) {
  const RadarVolume& volume = radar.pictures.volume;
  if (volume.width_px == 0) return;
  const Eigen::Vector3d x = volume.pixel_m * volume.width_px * volume.x_world;
  const Eigen::Vector3d y = volume.pixel_m * volume.height_px * volume.y_world;
  const auto at = [&](double i, double j, double depth_m) -> Eigen::Vector3d {
    return volume.origin_world + i * x + j * y + depth_m * volume.u_world;
  };
  const auto plane = [&](double depth_m, ImU32 fill, ImU32 edge) {
    std::array<ImVec2, 4> corners{};
    const std::array<std::array<double, 2>, 4> around = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto p = to_window(at(around[i][0], around[i][1], depth_m));
      if (!p) return;
      corners[i] = *p;
    }
    draw.AddConvexPolyFilled(corners.data(), 4, fill);
    draw.AddPolyline(corners.data(), 4, edge, ImDrawFlags_Closed, look::px(2.0F));
  };
  draw_box(
      draw,
      [&](int i) {
        return at((i & 1) != 0 ? 1 : 0, (i & 2) != 0 ? 1 : 0, (i & 4) != 0 ? volume.depth_m : 0.0);
      },
      to_window, IM_COL32(240, 178, 74, 200), look::px(1.5F));
  plane(0.0, IM_COL32(64, 196, 172, 36), look::kAccent);
  plane(volume.depth_m, IM_COL32(240, 178, 74, 36), look::kWarn);
  draw_line(draw, at(0.5, 0.5, volume.length_m), at(0.5, 0.5, volume.depth_m), to_window, look::kWarn,
            look::px(1.5F));
  if (const auto rear = to_window(at(0, 0, 0.0)))
    draw_label(draw, {rear->x + look::px(6.0F), rear->y - look::px(18.0F)}, "rear plane", look::kAccent,
               fonts);
  if (const auto far = to_window(at(0, 0, volume.depth_m)))
    draw_label(draw, {far->x + look::px(6.0F), far->y + look::px(6.0F)}, "far plane", look::kWarn, fonts);
  if (!radar.contact) return;
  if (const auto touch = to_window(radar.contact.point_world)) {
    draw.AddCircleFilled(*touch, look::px(4.5F), look::kBad);
    draw.AddCircle(*touch, look::px(8.0F), look::kBad, 0, look::px(1.5F));
    std::array<char, 48> text{};
    format_classic(text.data(), text.size(), "contact after %.1f mm", 1e3 * radar.contact.contact_distance_m);
    draw_label(draw, {touch->x + look::px(13.0F), touch->y - look::px(7.0F)}, text.data(), look::kText,
               fonts);
  }
}

void draw_camera(ImDrawList& draw, const ShownView& view, double depth_m, const ToWindow& to_window) {
  const Intrinsics& camera = view.camera;
  std::array<Eigen::Vector3d, 4> corners;
  const std::array<std::array<double, 2>, 4> around = {{{0, 0},
                                                        {1.0 * camera.width_px, 0},
                                                        {1.0 * camera.width_px, 1.0 * camera.height_px},
                                                        {0, 1.0 * camera.height_px}}};
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = view.T_world_view * back_project(camera, around[i][0], around[i][1], depth_m);
  const ImU32 colour = IM_COL32(222, 228, 236, 170);
  for (std::size_t i = 0; i < 4; ++i) {
    draw_line(draw, view.T_world_view.translation(), corners[i], to_window, colour, look::px(1.3F));
    draw_line(draw, corners[i], corners[(i + 1) % 4], to_window, colour, look::px(1.3F));
  }
}

}  // namespace roomradar
