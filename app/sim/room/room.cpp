// room.cpp: makes rooms by name, with exact distances and rays in them.
#include "app/sim/room/room.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Makes a bare room with a checkerboard on a stand, for camera calibration.
Room make_board_room() {
  Room room;
  room.name = "board";
  room.interior_min_world = {-3.5, -3.5, 0.0};
  room.interior_max_world = {3.5, 3.5, 3.0};
  add_shell(room, {Pattern::kPlanks, {196, 158, 112}, {140, 104, 66}, 301, 0.6F},
            {Pattern::kPlaster, {206, 204, 198}, {190, 186, 176}, 302, 0.7F},
            {Pattern::kPlaster, {236, 236, 234}, {226, 226, 222}, 303, 0.7F});
  // 9 by 7 squares, hence 8 by 6 inner corners, and a white margin of more than half a square.
  const Eigen::Vector3d board_m{10.2 * kCheckerSquare_m, 0.02, 8.2 * kCheckerSquare_m};
  constexpr double kMiddle_m = 1.4;
  add(room, Eigen::Isometry3d::Identity(), box({0, 0.01, kMiddle_m}, board_m),
      {Pattern::kChecker, {235, 235, 235}, {24, 24, 24}, 0, 0.6F});
  const Material metal{Pattern::kPortable, {90, 92, 96}, {70, 70, 74}, 304, 0.4F};
  add(room, Eigen::Isometry3d::Identity(), cylinder({0, 0.05, 0.02}, 0.02, kMiddle_m - 0.02), metal);
  add(room, Eigen::Isometry3d::Identity(), cylinder({0, 0.05, 0.0}, 0.2, 0.02), metal);

  room.lamps = {{{-1.5, -1.8, 2.8}, 2.8F, 0.3}, {{1.5, -1.8, 2.8}, 2.8F, 0.3}};
  room.focus_world = {0.0, 0.0, kMiddle_m};
  room.view_azimuth_rad = -0.5 * std::numbers::pi;
  room.walk_centre_world = {0.0, 0.0, 1.5};
  room.walk_half_m = {1.8, 1.8};
  room.ball_from_world = {-1.0, -1.0, 0.0};
  room.ball_to_world = {1.0, -1.0, 0.0};
  room.person_from_world = {-1.6, 1.5, 0.0};
  room.person_to_world = {1.6, 1.5, 0.0};
  return room;
}

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

/// Makes a living room with book shelves, sofa and coffee table.
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

/// Makes a dining room with table, four chairs, objects on the table, cupboard, window and pictures.
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

/// Makes a room with one big wall and almost nothing else. Geometry alone does not determine the camera's
/// pose.
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

}  // namespace

const std::vector<std::string>& room_names() {
  static const std::vector<std::string> names{"table", "shelf", "wall"};
  return names;
}

void require_room(std::string_view name) {
  const std::vector<std::string>& furnished = room_names();
  if (name == kRandomRoom || name == kFlatRoom || name == kBuildingRoom || name == kBoardRoom ||
      std::find(furnished.begin(), furnished.end(), name) != furnished.end())
    return;
  std::string known;
  for (const std::string& one : furnished) known.append(one).append(", ");
  for (const std::string_view one : {kRandomRoom, kFlatRoom, kBuildingRoom}) known.append(one).append(", ");
  known.append(kBoardRoom);
  throw Error("no simulated room is called '" + std::string(name) + "'; known are: " + known);
}

Room make_room(std::string_view name, bool crate, std::uint64_t seed, double moved) {
  require_room(name);
  if (name == kBuildingRoom)
    throw Error("the simulated building is not a single room; use it as a source, sim:building");
  Room room;
  if (name == "table") {
    room = make_table_room();
  } else if (name == "shelf") {
    room = make_shelf_room();
  } else if (name == "wall") {
    room = make_wall_room();
  } else if (name == kRandomRoom) {
    room = make_random_room(seed, {.half_m = {}, .doorways = {}, .moved = moved});
  } else if (name == kFlatRoom) {
    room = make_flat(seed);
  } else {
    room = make_board_room();
  }
  if (crate) {
    room.solids.push_back(crate_in(room));
    room.materials.push_back(crate_material());
  }
  room.tree = SolidTree(room.solids);
  return room;
}

Solid crate_in(const Room& room) {
  const Eigen::Vector3d foot = 0.5 * (room.ball_from_world + room.ball_to_world);
  Solid crate = box({0, 0, 0.5 * kCrateSize_m.z()}, kCrateSize_m);
  crate.T_world_solid = standing_at(foot.x(), foot.y(), foot.z(), 0.3) * crate.T_world_solid;
  return crate;
}

Material crate_material() { return {Pattern::kPoster, {206, 120, 60}, {60, 44, 36}, 71, 0.6F}; }

double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world) {
  return room.tree.signed_distance_m(room.solids, p_world);
}

std::optional<RayHit> cast_ray(const Room& room, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world) {
  return room.tree.cast(room.solids, origin_world, direction_world, std::numeric_limits<double>::infinity());
}

}  // namespace roomradar
