// room_table.cpp: a dining room: a table with four chairs and objects on it, a cupboard, pictures.
#include "app/sim/room/room_table.hpp"

#include <numbers>

#include "app/sim/room/furniture.hpp"

namespace roomradar {
namespace {

struct TableRoomLook {
  Material oak{Pattern::kWood, {196, 146, 92}, {142, 94, 52}, 7, 0.55F};
  Material walnut{Pattern::kWood, {128, 84, 54}, {78, 48, 30}, 8, 0.4F};
  Material white_wood{Pattern::kPortable, {236, 234, 228}, {210, 206, 198}, 9, 0.7F};
  Material frame{Pattern::kWood, {70, 52, 40}, {46, 34, 26}, 10, 0.35F};
};

/// Adds a rug with the table and its chairs.
void add_dining_table(Room& room, double top_m, const TableRoomLook& look) {
  constexpr double kRug_m = 0.008;
  add(room, Eigen::Isometry3d::Identity(), box({0, 0, 0.5 * kRug_m}, {2.6, 2.1, kRug_m}),
      {Pattern::kCarpet, {150, 48, 46}, {232, 206, 156}, 11, 0.5F});
  add_table(room, standing_at(0, 0, kRug_m), {1.6, 0.9, top_m - kRug_m}, look.oak);
  const Material blue_cloth{Pattern::kFabric, {58, 92, 128}, {186, 196, 200}, 12, 0.6F};
  add_chair(room, standing_at(-0.42, -0.62, kRug_m, 0.06), look.walnut, blue_cloth);
  add_chair(room, standing_at(0.40, -0.72, kRug_m, -0.22), look.walnut, blue_cloth);
  add_chair(room, standing_at(-0.40, 0.62, kRug_m, std::numbers::pi - 0.08), look.walnut, blue_cloth);
  add_chair(room, standing_at(0.42, 0.64, kRug_m, std::numbers::pi + 0.1), look.walnut, blue_cloth);
}

/// Adds the objects on the table; the middle of its front stays free.
void add_table_setting(Room& room, double top_m) {
  add_book_pile(room, standing_at(-0.56, 0.08, top_m, 0.3), 4, 40);
  add_mug(room, standing_at(-0.33, -0.24, top_m, 0.9),
          {Pattern::kTiles, {226, 226, 220}, {44, 100, 150}, 41, 0.6F});
  add_mug(room, standing_at(0.50, -0.26, top_m, 2.4),
          {Pattern::kPortable, {190, 60, 46}, {160, 40, 32}, 42, 0.6F});
  add_fruit_plate(room, standing_at(0.02, 0.27, top_m));
  add(room, standing_at(0.62, 0.16, top_m, -0.45), box({0, 0, 0.12}, {0.17, 0.065, 0.24}),
      {Pattern::kPoster, {240, 200, 72}, {178, 50, 40}, 43, 0.65F});
  add(room, standing_at(0.36, 0.3, top_m, 0.5), box({0, 0, 0.045}, {0.14, 0.1, 0.09}),
      {Pattern::kPoster, {90, 140, 130}, {236, 224, 200}, 44, 0.6F});
  add_cactus(room, standing_at(-0.24, 0.31, top_m));
  add(room, standing_at(-0.62, -0.27, top_m, 0.15), box({0, 0, 0.002}, {0.21, 0.297, 0.004}),
      {Pattern::kPoster, {244, 242, 236}, {60, 70, 90}, 45, 0.75F});
}

/// Adds cupboard and shelf along the walls, and the objects on the cupboard.
void add_wall_furniture(Room& room, const TableRoomLook& look) {
  add_cupboard(room, standing_at(-2.8 + 0.225, 0.35, 0, 0.5 * std::numbers::pi), {1.5, 0.45, 0.9}, look.oak);
  add_book_pile(room, standing_at(-2.55, -0.12, 0.9, 1.4), 3, 46);
  add_cactus(room, standing_at(-2.52, 0.28, 0.9));
  add(room, standing_at(-2.56, 0.75, 0.9, 1.3), box({0, 0, 0.15}, {0.34, 0.16, 0.3}),
      {Pattern::kSpine, {70, 62, 56}, {214, 190, 140}, 47, 0.25F});
  add_shelf(room, standing_at(-1.55, 2.5 - 0.15, 0, 0.0), {1.1, 0.3, 1.8}, 5, look.walnut, 48);
}

void add_pictures(Room& room, const TableRoomLook& look) {
  add_picture(room, standing_at(0.55, 2.5, 1.5, 0.0), 1.5, 1.1,
              {Pattern::kLandscape, {132, 180, 226}, {92, 134, 70}, 49, 0.5F}, look.white_wood);
  add_picture(room, standing_at(2.2, 2.5, 1.55, 0.0), 0.5, 0.7,
              {Pattern::kPoster, {236, 226, 206}, {196, 72, 44}, 50, 0.6F}, look.frame);
  add_picture(room, standing_at(2.8, 1.2, 1.5, -0.5 * std::numbers::pi), 0.9, 0.65,
              {Pattern::kPoster, {36, 62, 86}, {240, 186, 72}, 51, 0.5F}, look.frame);
  add_picture(room, standing_at(2.8, -0.2, 1.5, -0.5 * std::numbers::pi), 0.6, 0.8,
              {Pattern::kLandscape, {238, 190, 140}, {84, 96, 110}, 52, 0.6F}, look.frame);
  add_picture(room, standing_at(-2.8, 0.35, 1.55, 0.5 * std::numbers::pi), 1.0, 0.7,
              {Pattern::kPoster, {206, 216, 204}, {50, 100, 90}, 53, 0.6F}, look.white_wood);
  add_picture(room, standing_at(-2.8, -1.5, 1.45, 0.5 * std::numbers::pi), 0.5, 0.7,
              {Pattern::kPoster, {240, 232, 220}, {110, 60, 120}, 54, 0.6F}, look.frame);
  add_picture(room, standing_at(-1.2, -2.5, 1.5, std::numbers::pi), 0.8, 0.6,
              {Pattern::kLandscape, {170, 200, 220}, {110, 120, 60}, 55, 0.6F}, look.frame);
  add_picture(room, standing_at(0.2, -2.5, 1.5, std::numbers::pi), 0.6, 0.8,
              {Pattern::kPoster, {228, 196, 160}, {54, 76, 118}, 56, 0.6F}, look.white_wood);
}

/// Adds a door, a chest beside it, and a lamp.
void add_door_and_chest(Room& room) {
  add(room, Eigen::Isometry3d::Identity(), box({1.7, -2.5 + 0.02, 1.0}, {0.85, 0.04, 2.0}),
      {Pattern::kWood, {206, 190, 160}, {176, 154, 120}, 57, 0.6F});
  add(room, Eigen::Isometry3d::Identity(), rounded_box({1.4, -2.5 + 0.065, 1.02}, {0.12, 0.05, 0.02}, 0.009),
      {Pattern::kPortable, {160, 158, 150}, {120, 118, 110}, 58, 0.4F});
  add(room, Eigen::Isometry3d::Identity(), box({-1.5, -2.5 + 0.22, 0.22}, {0.9, 0.44, 0.44}),
      {Pattern::kPlanks, {150, 112, 70}, {96, 66, 40}, 59, 0.5F});
  add_floor_lamp(room, standing_at(2.4, 2.1, 0));
}

}  // namespace

Room make_table_room() {
  Room room;
  room.name = "table";
  room.interior_min_world = {-2.8, -2.5, 0.0};
  room.interior_max_world = {2.8, 2.5, 2.5};
  add_shell(room, {Pattern::kPlanks, {176, 128, 82}, {128, 84, 48}, 1, 0.5F},
            {Pattern::kPlaster, {226, 218, 200}, {206, 194, 170}, 2, 0.7F},
            {Pattern::kPlaster, {240, 240, 236}, {230, 228, 222}, 3, 0.7F});
  const TableRoomLook look;
  const double top_m = 0.75;
  add_dining_table(room, top_m, look);
  add_table_setting(room, top_m);
  add_wall_furniture(room, look);
  add_pictures(room, look);
  add_door_and_chest(room);

  room.lamps = {
      {{0.0, 0.0, 2.25}, 3.2F, 0.25}, {{0.6, 2.1, 1.7}, 1.1F, 0.5}, {{-1.6, -1.2, 2.3}, 1.4F, 0.25}};
  room.focus_world = {0.12, -0.12, top_m};
  room.view_azimuth_rad = -0.5 * std::numbers::pi;
  room.walk_centre_world = {0.0, 0.0, 1.5};
  room.walk_half_m = {1.75, 1.5};
  room.ball_from_world = {-0.2, -0.36, top_m};
  room.ball_to_world = {0.42, -0.05, top_m};
  room.person_from_world = {-0.8, 1.75, 0.0};
  room.person_to_world = {1.7, 1.75, 0.0};
  return room;
}

}  // namespace roomradar
