// room_shelf.cpp: a living room: book shelves, a sofa, and a coffee table with objects on it.
#include "app/sim/room/room_shelf.hpp"

#include <numbers>

#include "app/sim/room/furniture.hpp"

namespace roomradar {
namespace {

/// Adds a rug with the coffee table, and what is on the table.
void add_coffee_table(Room& room, double top_m) {
  constexpr double kRug_m = 0.01;
  add(room, Eigen::Isometry3d::Identity(), box({0, 0.1, 0.5 * kRug_m}, {2.2, 1.6, kRug_m}),
      {Pattern::kCarpet, {44, 72, 98}, {226, 214, 188}, 111, 0.5F});
  add_table(room, standing_at(0, 0.1, kRug_m), {1.2, 0.7, top_m - kRug_m},
            {Pattern::kWood, {118, 78, 52}, {70, 44, 28}, 108, 0.4F});
  add_book_pile(room, standing_at(-0.38, 0.22, top_m, -0.4), 5, 140);
  add_mug(room, standing_at(0.36, -0.08, top_m, 0.7),
          {Pattern::kTiles, {40, 90, 110}, {230, 220, 200}, 141, 0.6F});
  add_cactus(room, standing_at(0.42, 0.3, top_m));
  add(room, standing_at(0.1, 0.33, top_m, 0.2), box({0, 0, 0.05}, {0.24, 0.12, 0.1}),
      {Pattern::kPoster, {214, 120, 60}, {250, 236, 210}, 142, 0.6F});
  add(room, standing_at(-0.42, -0.1, top_m, 0.5), box({0, 0, 0.003}, {0.2, 0.27, 0.006}),
      {Pattern::kPoster, {236, 232, 224}, {170, 40, 60}, 143, 0.7F});
}

}  // namespace

Room make_shelf_room() {
  Room room;
  room.name = "shelf";
  room.interior_min_world = {-2.7, -2.4, 0.0};
  room.interior_max_world = {2.7, 2.4, 2.5};
  add_shell(room, {Pattern::kTiles, {190, 182, 168}, {120, 112, 100}, 101, 0.55F},
            {Pattern::kPlaster, {204, 214, 208}, {180, 194, 188}, 102, 0.7F},
            {Pattern::kPlaster, {242, 242, 238}, {230, 230, 224}, 103, 0.7F});
  const Material birch{Pattern::kWood, {222, 190, 142}, {184, 144, 96}, 107, 0.6F};
  const Material frame{Pattern::kPortable, {44, 42, 40}, {30, 28, 26}, 110, 0.12F};
  const auto world = Eigen::Isometry3d::Identity();

  const double top_m = 0.46;
  add_coffee_table(room, top_m);

  add_shelf(room, standing_at(-1.5, 2.4 - 0.16, 0), {1.3, 0.32, 2.1}, 6, birch, 150);
  add_shelf(room, standing_at(-0.15, 2.4 - 0.16, 0), {1.3, 0.32, 2.1}, 6, birch, 151);
  add_shelf(room, standing_at(1.2, 2.4 - 0.16, 0), {1.3, 0.32, 1.1}, 3, birch, 152);
  add_cactus(room, standing_at(0.9, 2.4 - 0.18, 1.1));
  add_book_pile(room, standing_at(1.4, 2.4 - 0.17, 1.1, 0.1), 3, 153);
  add_picture(room, standing_at(1.2, 2.4, 1.75), 0.9, 0.6,
              {Pattern::kLandscape, {160, 190, 220}, {80, 110, 80}, 154, 0.6F}, frame);
  add_sofa(room, standing_at(-2.7 + 0.45, 0.1, 0, 0.5 * std::numbers::pi), 1.9,
           {Pattern::kFabric, {92, 120, 100}, {120, 150, 128}, 155, 0.6F},
           {Pattern::kCarpet, {206, 116, 50}, {244, 226, 190}, 156, 0.6F});
  add_picture(room, standing_at(-2.7, 0.1, 1.6, 0.5 * std::numbers::pi), 1.2, 0.8,
              {Pattern::kPoster, {240, 234, 222}, {44, 80, 120}, 157, 0.6F}, frame);
  add_cupboard(room, standing_at(2.7 - 0.2, 0.3, 0, -0.5 * std::numbers::pi), {1.6, 0.4, 0.6}, birch);
  add(room, standing_at(2.7 - 0.16, 0.3, 0.6, -0.5 * std::numbers::pi), box({0, 0, 0.34}, {1.0, 0.05, 0.58}),
      {Pattern::kPortable, {22, 22, 26}, {14, 14, 16}, 158, 0.03F});
  add(room, standing_at(2.7 - 0.16, 0.3, 0.6, -0.5 * std::numbers::pi), box({0, 0, 0.025}, {0.4, 0.18, 0.05}),
      {Pattern::kPortable, {40, 40, 44}, {28, 28, 30}, 159, 0.08F});
  add_picture(room, standing_at(2.7, -1.3, 1.5, -0.5 * std::numbers::pi), 0.7, 0.9,
              {Pattern::kPoster, {60, 90, 80}, {240, 210, 120}, 160, 0.6F}, frame);
  add_picture(room, standing_at(-1.3, -2.4, 1.5, std::numbers::pi), 1.3, 1.0,
              {Pattern::kLandscape, {140, 186, 230}, {100, 140, 80}, 161, 0.5F},
              {Pattern::kPortable, {238, 238, 232}, {214, 214, 206}, 162, 0.7F});
  add_picture(room, standing_at(0.4, -2.4, 1.5, std::numbers::pi), 0.6, 0.6,
              {Pattern::kPoster, {244, 220, 196}, {120, 40, 90}, 163, 0.6F}, frame);
  add(room, world, box({1.7, -2.4 + 0.02, 1.0}, {0.85, 0.04, 2.0}),
      {Pattern::kWood, {190, 176, 150}, {156, 138, 110}, 164, 0.6F});
  add_floor_lamp(room, standing_at(-2.35, 1.6, 0));
  add(room, standing_at(-2.3, -1.55, 0, 0.2), rounded_box({0, 0, 0.21}, {0.5, 0.5, 0.42}, 0.06),
      {Pattern::kCarpet, {120, 70, 60}, {226, 190, 140}, 165, 0.5F});

  room.lamps = {
      {{0.0, 0.0, 2.25}, 3.0F, 0.25}, {{-1.3, -2.0, 1.7}, 1.2F, 0.5}, {{1.7, 1.2, 2.3}, 1.2F, 0.25}};
  room.focus_world = {0.0, 0.0, top_m};
  room.view_azimuth_rad = -0.45 * std::numbers::pi;
  room.walk_centre_world = {0.1, -0.1, 1.45};
  room.walk_half_m = {1.45, 1.35};
  room.ball_from_world = {-0.9, -0.75, 0.0};
  room.ball_to_world = {1.2, -0.75, 0.0};
  room.person_from_world = {-1.2, 1.2, 0.0};
  room.person_to_world = {1.6, 1.2, 0.0};
  return room;
}

}  // namespace roomradar
