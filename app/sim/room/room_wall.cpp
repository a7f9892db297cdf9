// room_wall.cpp: a nearly empty room with one big wall, in which geometry alone does not determine the
// camera's pose.
#include "app/sim/room/room_wall.hpp"

#include <numbers>

#include "app/sim/room/furniture.hpp"

namespace roomradar {

Room make_wall_room() {
  Room room;
  room.name = "wall";
  room.interior_min_world = {-3.6, -2.6, 0.0};
  room.interior_max_world = {3.6, 2.6, 2.8};
  add_shell(room, {Pattern::kStone, {188, 184, 176}, {124, 118, 110}, 201, 0.55F},
            {Pattern::kPlaster, {222, 216, 206}, {190, 178, 160}, 202, 0.7F},
            {Pattern::kPlaster, {240, 240, 238}, {228, 228, 224}, 203, 0.7F});
  const Material poster_frame{Pattern::kPortable, {60, 56, 52}, {40, 38, 36}, 204, 0.3F};
  const auto paper = [](std::uint32_t seed, Rgb ground, Rgb ink) {
    return Material{Pattern::kPoster, ground, ink, seed, 0.65F};
  };
  // Posters without frames, which give a tracker colour but hardly any shape.
  const auto add_sheet = [&](double x_m, double z_m, double width_m, double height_m, const Material& sheet) {
    add(room, standing_at(x_m, 2.6, z_m), box({0, -0.001, 0}, {width_m, 0.002, height_m}), sheet);
  };
  add_sheet(-2.3, 1.5, 0.7, 1.0, paper(211, {238, 230, 214}, {40, 90, 130}));
  add_sheet(-0.9, 1.65, 0.9, 0.6, paper(212, {240, 204, 110}, {150, 40, 40}));
  add_sheet(0.5, 1.45, 0.6, 0.85, paper(213, {70, 104, 96}, {236, 226, 196}));
  add_sheet(1.9, 1.6, 1.0, 0.7, {Pattern::kLandscape, {150, 190, 226}, {96, 130, 72}, 214, 0.6F});
  add_picture(room, standing_at(-3.6, 0.0, 1.5, 0.5 * std::numbers::pi), 0.8, 0.6,
              paper(215, {226, 226, 218}, {120, 60, 40}), poster_frame);
  add_picture(room, standing_at(3.6, 0.2, 1.5, -0.5 * std::numbers::pi), 0.6, 0.8,
              paper(216, {200, 160, 120}, {40, 60, 90}), poster_frame);
  add(room, Eigen::Isometry3d::Identity(), box({-1.6, -2.6 + 0.02, 1.02}, {0.9, 0.04, 2.04}),
      {Pattern::kWood, {200, 182, 150}, {166, 146, 112}, 217, 0.6F});
  // One crate on the floor, the view's focus, and a bench far from it.
  const double crate_top_m = 0.4;
  add(room, standing_at(0.0, 1.2, 0, 0.2), box({0, 0, 0.5 * crate_top_m}, {0.7, 0.5, crate_top_m}),
      {Pattern::kPlanks, {190, 150, 100}, {130, 94, 56}, 218, 0.55F});
  add_table(room, standing_at(2.2, -2.25, 0), {1.4, 0.4, 0.45},
            {Pattern::kWood, {150, 104, 66}, {100, 66, 40}, 219, 0.5F});

  room.lamps = {{{-1.2, 0.2, 2.6}, 2.8F, 0.3}, {{1.6, 0.2, 2.6}, 2.8F, 0.3}, {{0.0, -1.8, 2.4}, 1.2F, 0.3}};
  room.focus_world = {0.0, 1.15, crate_top_m};
  room.view_azimuth_rad = -0.5 * std::numbers::pi;
  room.walk_centre_world = {0.0, -0.25, 1.5};
  room.walk_half_m = {1.75, 1.2};
  room.ball_from_world = {-1.4, 0.6, 0.0};
  room.ball_to_world = {1.3, 0.6, 0.0};
  room.person_from_world = {-1.6, 2.05, 0.0};
  room.person_to_world = {1.6, 2.05, 0.0};
  return room;
}

}  // namespace roomradar
