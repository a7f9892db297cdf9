// model_view.cpp: the meshes of a session, in a 3D view.
#include "app/window/panes/panes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "app/window/panes/annotate.hpp"
#include "app/window/panes/orbit_canvas.hpp"

namespace roomradar {
namespace {

constexpr double kLookedAt_m = 1.0;  // in front of the camera, where users place objects

/// Draws the meaning of the colours along the bottom, in as many rows as the width needs.
void draw_legend(ImDrawList& list, const Area& area, const look::Fonts& fonts) {
  struct Entry {
    ImU32 colour;
    const char* what;
    float x = 0.0F;
    int row = 0;
  };
  std::array<Entry, 4> legend = {{{IM_COL32(158, 168, 184, 255), "room"},
                                  {IM_COL32(237, 115, 102, 255), "dynamic"},
                                  {IM_COL32(140, 92, 158, 255), "inferred back"},
                                  {IM_COL32(64, 196, 172, 255), "chosen object"}}};
  const float margin = look::px(12.0F), beside_dot = look::px(9.0F), size = fonts.small->FontSize;
  float x = margin;
  int row = 0;
  for (Entry& entry : legend) {
    const float wide = beside_dot + fonts.small->CalcTextSizeA(size, 1e4F, 0.0F, entry.what).x;
    if (x > margin && x + wide > area.width - margin) {
      x = margin;
      ++row;
    }
    entry.x = area.x + x;
    entry.row = row;
    x += wide + look::px(16.0F);
  }
  for (const Entry& entry : legend) {
    const float y =
        area.y + area.height - look::px(22.0F) - look::px(16.0F) * static_cast<float>(row - entry.row);
    list.AddCircleFilled({entry.x, y + look::px(7.0F)}, look::px(4.0F), entry.colour);
    list.AddText(fonts.small, size, {entry.x + beside_dot, y}, look::kDim, entry.what);
  }
}

}  // namespace

struct ModelView::State {
  OrbitCanvas canvas;
  bool is_placed = false;  ///< the orbit was set to show the room
  std::shared_ptr<const ShownRoom> room;
  DrawnMesh drawn_room, drawn_seen, drawn_inferred;
  std::map<std::shared_ptr<const Mesh>, std::unique_ptr<DrawnMesh>> drawn_objects;
};

ModelView::ModelView() : state_(std::make_unique<State>()) {}
ModelView::~ModelView() = default;

void ModelView::upload(const Snapshot& shown) {
  State& state = *state_;
  state.canvas.content_changed();
  if (shown.room && shown.room != state.room) {
    state.room = shown.room;
    state.drawn_room.upload(shown.room->mesh, /*changes_often=*/false);
    state.drawn_room.upload_texture(shown.room->texture_points, shown.room->texture);
    const Eigen::AlignedBox3d box = bounds_of(shown.room->mesh);
    if (!state.is_placed && !box.isEmpty()) {
      state.is_placed = true;
      state.canvas.orbit.target_world = box.center();
      state.canvas.orbit.distance_m = std::clamp(1.1 * box.diagonal().norm(), 1.0, 30.0);
      // From behind the camera and beside it, to its target, so left and right match the picture.
      if (shown.view) {
        const Eigen::Vector3d back = -shown.view->T_world_view.linear().col(2);
        state.canvas.orbit.azimuth_rad = std::atan2(back.y(), back.x()) + 0.45;
        state.canvas.orbit.target_world = shown.view->T_world_view.translation() - kLookedAt_m * back;
        state.canvas.orbit.distance_m = 2.6 * kLookedAt_m;
      }
    }
  }
  state.drawn_seen.upload(shown.seen_world, /*changes_often=*/true);
  state.drawn_inferred.upload(shown.inferred_world, /*changes_often=*/true);
  for (const ShownObject& object : shown.objects) {
    auto& drawn = state.drawn_objects[object.mesh];
    if (drawn) continue;
    drawn = std::make_unique<DrawnMesh>();
    drawn->upload(*object.mesh, /*changes_often=*/false);
  }
}

void ModelView::look_at_chosen(const Snapshot& shown) {
  for (const ShownObject& object : shown.objects) {
    if (object.name != shown.chosen || !object.in_room) continue;
    state_->canvas.orbit.target_world = object.T_world_object * object.box.center();
    state_->canvas.orbit.distance_m = std::clamp(5.0 * object.box.diagonal().norm(), 0.4, 5.0);
    state_->canvas.orbit_changed();
  }
}

void ModelView::render(int width_px, int height_px, const Snapshot& shown) {
  State& state = *state_;
  if (!state.canvas.must_render(width_px, height_px)) return;
  OrbitCanvas& canvas = state.canvas;
  const Eigen::Isometry3d at_home = Eigen::Isometry3d::Identity();
  canvas.begin();
  canvas.draw(state.drawn_room, at_home, {{0.62F, 0.66F, 0.72F}, 0.25F}, /*is_transparent_behind=*/true);
  canvas.draw(state.drawn_inferred, at_home, {{0.55F, 0.36F, 0.62F}, 1.0F});
  canvas.draw(state.drawn_seen, at_home, {{0.93F, 0.45F, 0.40F}, 0.85F});
  for (const ShownObject& object : shown.objects) {
    if (!object.in_room) continue;
    canvas.draw(*state.drawn_objects.at(object.mesh), object.T_world_object,
                {object.name == shown.chosen ? std::array<float, 3>{0.25F, 0.77F, 0.67F}
                                             : std::array<float, 3>{0.78F, 0.47F, 0.28F},
                 1.0F});
  }
  canvas.end();
}

void ModelView::draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts) {
  look::begin_pane("models", area, look::kGround);
  const int width_px = static_cast<int>(area.width), height_px = static_cast<int>(area.height);
  ImGui::SetCursorScreenPos({area.x, area.y});
  ImGui::InvisibleButton("orbit", {area.width, area.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  state_->canvas.steer(area);
  render(width_px, height_px, shown);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  state_->canvas.show(area);
  const ToWindow to_window = state_->canvas.to_window(area);
  if (shown.view) draw_camera(list, *shown.view, 0.45, to_window);
  draw_target_volume(list, shown.shown_radar, to_window, fonts);
  draw_legend(list, area, fonts);
  look::end_pane();
}

}  // namespace roomradar
