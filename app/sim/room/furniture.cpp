// furniture.cpp: builds tables, chairs, shelves and objects on them from solids that touch but do not
// overlap.
#include "app/sim/room/furniture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Material kMetal{Pattern::kPortable, {150, 152, 156}, {120, 122, 126}, 3, 0.45F};
constexpr Material kDarkPlastic{Pattern::kPortable, {34, 34, 38}, {20, 20, 22}, 4, 0.05F};

Material book_cover(std::uint32_t seed) {
  constexpr std::array<Rgb, 10> kCovers{{{158, 42, 43},
                                         {36, 84, 122},
                                         {46, 104, 70},
                                         {212, 160, 48},
                                         {92, 60, 110},
                                         {198, 92, 46},
                                         {220, 212, 190},
                                         {60, 66, 78},
                                         {120, 160, 170},
                                         {176, 120, 130}}};
  const std::uint64_t h = hash_of(seed, 17);
  const Rgb ground = kCovers[h % kCovers.size()];
  const bool light = ground.r + ground.g + ground.b > 380;
  return {Pattern::kSpine, ground, light ? Rgb{60, 40, 30} : Rgb{236, 222, 180}, seed, 0.6F};
}

}  // namespace

Isometry3d standing_at(double x_m, double y_m, double z_m, double yaw_rad) {
  Isometry3d T_world_piece = Isometry3d::Identity();
  T_world_piece.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T_world_piece.translation() = Vector3d(x_m, y_m, z_m);
  return T_world_piece;
}

void add(Room& room, const Isometry3d& T_world_piece, Solid solid_piece, const Material& material) {
  solid_piece.T_world_solid = T_world_piece * solid_piece.T_world_solid;
  room.solids.push_back(solid_piece);
  room.materials.push_back(material);
}

void add_shell(Room& room, const Material& floor, const Material& wall, const Material& ceiling,
               std::span<const Doorway> doorways) {
  const Vector3d low = room.interior_min_world;
  const Vector3d high = room.interior_max_world;
  const Vector3d middle = 0.5 * (low + high);
  const Vector3d size = high - low;
  constexpr double kThick_m = kShellThickness_m;
  const Isometry3d world = Isometry3d::Identity();
  const Vector3d slab(size.x() + 2 * kThick_m, size.y() + 2 * kThick_m, kThick_m);
  add(room, world, box({middle.x(), middle.y(), low.z() - 0.5 * kThick_m}, slab), floor);
  add(room, world, box({middle.x(), middle.y(), high.z() + 0.5 * kThick_m}, slab), ceiling);
  // Each wall's frame has -y into the room, so patterns are upright and not mirrored.
  const auto add_wall = [&](double x_m, double y_m, double yaw_rad, double length_m, unsigned number) {
    Material paint = wall;
    paint.seed += number + 1;
    const Isometry3d T_world_wall = standing_at(x_m, y_m, low.z(), yaw_rad);
    const auto add_part = [&](double from_x, double to_x, double from_z) {
      add(room, T_world_wall,
          box({0.5 * (from_x + to_x), 0.5 * kThick_m, 0.5 * (from_z + size.z())},
              {to_x - from_x, kThick_m, size.z() - from_z}),
          paint);
    };
    const auto door = std::find_if(doorways.begin(), doorways.end(),
                                   [number](const Doorway& each) { return each.wall == number; });
    if (door == doorways.end()) return add_part(-0.5 * length_m, 0.5 * length_m, 0.0);
    const double left_m = door->centre_m - 0.5 * door->width_m,
                 right_m = door->centre_m + 0.5 * door->width_m;
    add_part(-0.5 * length_m, left_m, 0.0);
    add_part(left_m, right_m, kDoorwayHeight_m);
    add_part(right_m, 0.5 * length_m, 0.0);
  };
  add_wall(middle.x(), high.y(), 0.0, size.x() + 2 * kThick_m, 0);
  add_wall(middle.x(), low.y(), std::numbers::pi, size.x() + 2 * kThick_m, 1);
  add_wall(low.x(), middle.y(), 0.5 * std::numbers::pi, size.y(), 2);
  add_wall(high.x(), middle.y(), -0.5 * std::numbers::pi, size.y(), 3);
}

void add_picture(Room& room, const Isometry3d& T_world_picture, double width_m, double height_m,
                 const Material& picture, const Material& frame) {
  constexpr double kBar_m = 0.035;
  constexpr double kFrameDepth_m = 0.03;
  constexpr double kSheet_m = 0.01;
  add(room, T_world_picture, box({0, -0.5 * kSheet_m, 0}, {width_m, kSheet_m, height_m}), picture);
  const double bar_x = 0.5 * (width_m + kBar_m);
  const double bar_z = 0.5 * (height_m + kBar_m);
  for (const double side : {-1.0, 1.0}) {
    add(room, T_world_picture,
        box({side * bar_x, -0.5 * kFrameDepth_m, 0}, {kBar_m, kFrameDepth_m, height_m + 2 * kBar_m}), frame);
    add(room, T_world_picture, box({0, -0.5 * kFrameDepth_m, side * bar_z}, {width_m, kFrameDepth_m, kBar_m}),
        frame);
  }
}

void add_table(Room& room, const Isometry3d& T_world_table, const Vector3d& size_m,
               const Material& material) {
  constexpr double kBoard_m = 0.035;
  constexpr double kLeg_m = 0.06;
  constexpr double kApron_m = 0.09;
  const double leg_m = size_m.z() - kBoard_m;
  add(room, T_world_table, box({0, 0, leg_m + 0.5 * kBoard_m}, {size_m.x(), size_m.y(), kBoard_m}), material);
  const double x = 0.5 * size_m.x() - 0.06 - 0.5 * kLeg_m;
  const double y = 0.5 * size_m.y() - 0.05 - 0.5 * kLeg_m;
  for (const double side_x : {-1.0, 1.0})
    for (const double side_y : {-1.0, 1.0})
      add(room, T_world_table, box({side_x * x, side_y * y, 0.5 * leg_m}, {kLeg_m, kLeg_m, leg_m}), material);
  for (const double side : {-1.0, 1.0}) {
    add(room, T_world_table, box({0, side * y, leg_m - 0.5 * kApron_m}, {2 * x - kLeg_m, 0.022, kApron_m}),
        material);
    add(room, T_world_table, box({side * x, 0, leg_m - 0.5 * kApron_m}, {0.022, 2 * y - kLeg_m, kApron_m}),
        material);
  }
}

void add_chair(Room& room, const Isometry3d& T_world_chair, const Material& wood, const Material& cushion) {
  constexpr double kLeg_m = 0.04;
  constexpr double kHalf_m = 0.2;
  constexpr double kSeat_m = 0.43;
  for (const double side : {-1.0, 1.0}) {
    add(room, T_world_chair, box({side * kHalf_m, kHalf_m, 0.2}, {kLeg_m, kLeg_m, 0.4}), wood);
    add(room, T_world_chair, box({side * kHalf_m, -kHalf_m - 0.02, 0.45}, {kLeg_m, kLeg_m, 0.9}), wood);
  }
  add(room, T_world_chair, box({0, 0.01, 0.5 * (0.4 + kSeat_m)}, {0.44, 0.42, kSeat_m - 0.4}), wood);
  add(room, T_world_chair, rounded_box({0, 0.012, kSeat_m + 0.02}, {0.4, 0.39, 0.04}, 0.018), cushion);
  for (const double height_m : {0.84, 0.72, 0.6})
    add(room, T_world_chair, box({0, -kHalf_m - 0.02, height_m}, {2 * kHalf_m - kLeg_m, 0.02, 0.07}), wood);
}

void add_shelf(Room& room, const Isometry3d& T_world_shelf, const Vector3d& size_m, int levels,
               const Material& wood, std::uint32_t seed) {
  constexpr double kBoard_m = 0.025;
  const double inner_m = size_m.x() - 2 * kBoard_m;
  for (const double side : {-1.0, 1.0})
    add(room, T_world_shelf,
        box({side * 0.5 * (size_m.x() - kBoard_m), 0, 0.5 * size_m.z()}, {kBoard_m, size_m.y(), size_m.z()}),
        wood);
  add(room, T_world_shelf, box({0, 0.5 * size_m.y() - 0.006, 0.5 * size_m.z()}, {inner_m, 0.012, size_m.z()}),
      wood);
  const double board_y = -0.006;
  const double board_depth_m = size_m.y() - 0.012;
  for (int level = 0; level <= levels; ++level) {
    const double top_m = kBoard_m + (size_m.z() - kBoard_m) * level / levels;
    add(room, T_world_shelf, box({0, board_y, top_m - 0.5 * kBoard_m}, {inner_m, board_depth_m, kBoard_m}),
        wood);
    if (level == levels) break;
    const double room_above_m = (size_m.z() - kBoard_m) / levels - kBoard_m;
    double x = -0.5 * inner_m + 0.004;
    for (std::uint32_t item = 0;; ++item) {
      CounterRandom random(seed, static_cast<std::uint64_t>(level) * 1000 + item);
      const std::uint32_t look = seed * 977 + static_cast<std::uint32_t>(level) * 131 + item;
      const double kind = random.uniform();
      if (kind < 0.8) {
        const double thick_m = random.uniform(0.018, 0.05);
        const double high_m = std::min(random.uniform(0.19, 0.3), room_above_m - 0.01);
        const double deep_m = random.uniform(0.15, std::min(0.22, board_depth_m - 0.03));
        if (x + thick_m > 0.5 * inner_m) break;
        add(room, T_world_shelf,
            box({x + 0.5 * thick_m, 0.5 * size_m.y() - 0.012 - 0.5 * deep_m - 0.01, top_m + 0.5 * high_m},
                {thick_m - 0.001, deep_m, high_m}),
            book_cover(look));
        x += thick_m;
      } else if (kind < 0.87) {
        x += random.uniform(0.05, 0.16);  // a gap
      } else if (kind < 0.94) {
        const double radius_m = std::min(random.uniform(0.04, 0.07), 0.5 * room_above_m - 0.01);
        if (x + 2 * radius_m + 0.02 > 0.5 * inner_m) break;
        add(room, T_world_shelf,
            cylinder({x + radius_m + 0.01, -0.02, top_m}, radius_m, std::min(0.2, room_above_m - 0.03)),
            {Pattern::kTiles, {198, 96, 62}, {240, 228, 206}, look, 0.5F});
        x += 2 * radius_m + 0.02;
      } else {
        const double size = std::min(random.uniform(0.14, 0.2), room_above_m - 0.02);
        if (x + size + 0.02 > 0.5 * inner_m) break;
        add(room, T_world_shelf,
            box({x + 0.5 * size + 0.01, -0.02, top_m + 0.4 * size}, {size, 0.18, 0.8 * size}),
            {Pattern::kPoster, {224, 214, 196}, {70, 110, 140}, look, 0.6F});
        x += size + 0.02;
      }
    }
  }
}

void add_cupboard(Room& room, const Isometry3d& T_world_cupboard, const Vector3d& size_m,
                  const Material& wood) {
  constexpr double kDoor_m = 0.02;
  constexpr double kPlinth_m = 0.06;
  add(room, T_world_cupboard,
      box({0, 0.5 * kDoor_m, 0.5 * kPlinth_m}, {size_m.x() - 0.06, size_m.y() - 0.08, kPlinth_m}),
      kDarkPlastic);
  const double body_m = size_m.z() - kPlinth_m;
  add(room, T_world_cupboard,
      box({0, 0.5 * kDoor_m, kPlinth_m + 0.5 * body_m}, {size_m.x(), size_m.y() - kDoor_m, body_m}), wood);
  const double front_y = -0.5 * size_m.y();
  const double door_width_m = 0.5 * size_m.x() - 0.01;
  for (const double side : {-1.0, 1.0}) {
    Material door = wood;
    door.seed += side > 0 ? 11 : 12;
    add(room, T_world_cupboard,
        box({side * 0.25 * size_m.x(), front_y + 0.5 * kDoor_m, kPlinth_m + 0.5 * body_m},
            {door_width_m, kDoor_m, body_m - 0.02}),
        door);
    add(room, T_world_cupboard,
        rounded_box({side * 0.05, front_y - 0.0125, 0.55 * size_m.z()}, {0.02, 0.025, 0.16}, 0.009), kMetal);
  }
}

void add_sofa(Room& room, const Isometry3d& T_world_sofa, double width_m, const Material& fabric,
              const Material& pillow) {
  const double inner_m = width_m - 0.36;
  for (const double side : {-1.0, 1.0}) {
    add(room, T_world_sofa, rounded_box({side * 0.5 * (width_m - 0.18), 0, 0.34}, {0.18, 0.86, 0.52}, 0.06),
        fabric);
    for (const double depth : {-1.0, 1.0})
      add(room, T_world_sofa, cylinder({side * 0.5 * (width_m - 0.18), depth * 0.32, 0}, 0.025, 0.08),
          kDarkPlastic);
  }
  add(room, T_world_sofa, rounded_box({0, 0, 0.18}, {inner_m, 0.84, 0.2}, 0.03), fabric);
  add(room, T_world_sofa, rounded_box({0, 0.33, 0.56}, {inner_m, 0.18, 0.56}, 0.07), fabric);
  for (const double side : {-1.0, 1.0})
    add(room, T_world_sofa,
        rounded_box({side * 0.25 * inner_m, -0.09, 0.365}, {0.5 * inner_m - 0.006, 0.65, 0.17}, 0.05),
        fabric);
  // A pillow leaning on the back: its lowest edge rests on the seat cushion, its back touches the sofa's.
  constexpr double kLean_rad = 0.3;
  constexpr double kPillowRound_m = 0.055;
  const Vector3d core_half(0.13, 0.005, 0.13);
  Solid leaning{SolidShape::kBox, Isometry3d::Identity(), core_half, kPillowRound_m};
  leaning.T_world_solid.linear() = Eigen::AngleAxisd(-kLean_rad, Vector3d::UnitX()).toRotationMatrix();
  const double reach_z =
      std::cos(kLean_rad) * core_half.z() + std::sin(kLean_rad) * core_half.y() + kPillowRound_m;
  const double reach_y =
      std::cos(kLean_rad) * core_half.y() + std::sin(kLean_rad) * core_half.z() + kPillowRound_m;
  leaning.T_world_solid.translation() = Vector3d(-0.36 * inner_m, 0.24 - reach_y, 0.45 + reach_z);
  add(room, T_world_sofa, leaning, pillow);
}

void add_book_pile(Room& room, const Isometry3d& T_world_pile, int books, std::uint32_t seed) {
  double top_m = 0.0;
  for (int i = 0; i < books; ++i) {
    CounterRandom random(seed, static_cast<std::uint64_t>(i));
    const double shrink = 1.0 - 0.07 * i;
    const Vector3d size(0.26 * shrink, 0.19 * shrink, random.uniform(0.022, 0.045));
    add(room, T_world_pile, box({0, 0, top_m + 0.5 * size.z()}, size, random.uniform(-0.35, 0.35)),
        book_cover(seed * 31 + static_cast<std::uint32_t>(i)));
    top_m += size.z();
  }
}

void add_mug(Room& room, const Isometry3d& T_world_mug, const Material& material) {
  constexpr double kRadius_m = 0.041;
  add(room, T_world_mug, cylinder({0, 0, 0}, kRadius_m, 0.095), material);
  add(room, T_world_mug, rounded_box({kRadius_m + 0.011, 0, 0.072}, {0.022, 0.014, 0.014}, 0.006), material);
  add(room, T_world_mug, rounded_box({kRadius_m + 0.011, 0, 0.026}, {0.022, 0.014, 0.014}, 0.006), material);
  add(room, T_world_mug, rounded_box({kRadius_m + 0.029, 0, 0.049}, {0.014, 0.014, 0.06}, 0.006), material);
}

void add_cactus(Room& room, const Isometry3d& T_world_pot) {
  const Material clay{Pattern::kTiles, {190, 98, 62}, {224, 150, 108}, 5, 0.6F};
  const Material green{Pattern::kSpine, {58, 112, 66}, {160, 190, 120}, 9, 0.5F};
  add(room, T_world_pot, cylinder({0, 0, 0}, 0.06, 0.1), clay);
  Solid body{SolidShape::kBox, standing_at(0, 0, 0.1 + 0.04 + 0.07), {0, 0, 0.07}, 0.04};
  add(room, T_world_pot, body, green);
}

void add_fruit_plate(Room& room, const Isometry3d& T_world_plate) {
  const Material china{Pattern::kTiles, {236, 236, 230}, {64, 96, 160}, 21, 0.6F};
  const Material orange{Pattern::kSkin, {232, 132, 30}, {206, 96, 16}, 22, 0.6F};
  const Material apple{Pattern::kSkin, {188, 36, 40}, {226, 170, 70}, 23, 0.6F};
  constexpr double kPlate_m = 0.02;
  constexpr double kFruit_m = 0.037;
  add(room, T_world_plate, cylinder({0, 0, 0}, 0.14, kPlate_m), china);
  const double ring_m = kFruit_m * 2.0 / std::sqrt(3.0) + 1e-4;  // three spheres that touch
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 3.0 + 0.4;
    add(room, T_world_plate,
        sphere({ring_m * std::cos(angle), ring_m * std::sin(angle), kPlate_m + kFruit_m}, kFruit_m),
        i == 1 ? apple : orange);
  }
  const double lift_m = std::sqrt(4.0 * kFruit_m * kFruit_m - ring_m * ring_m) + 1e-4;
  add(room, T_world_plate, sphere({0, 0, kPlate_m + kFruit_m + lift_m}, kFruit_m), apple);
}

void add_floor_lamp(Room& room, const Isometry3d& T_world_lamp) {
  const Material shade{Pattern::kFabric, {246, 226, 178}, {232, 200, 140}, 31, 0.7F};
  add(room, T_world_lamp, cylinder({0, 0, 0}, 0.14, 0.025), kDarkPlastic);
  add(room, T_world_lamp, cylinder({0, 0, 0.025}, 0.014, 1.35), kMetal);
  add(room, T_world_lamp, cylinder({0, 0, 1.375}, 0.19, 0.26), shade);
}

}  // namespace roomradar
