// room_random.cpp: a room of random size, with random furniture where it fits, and objects on it.
#include "app/sim/room/room_random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "app/sim/room/furniture.hpp"
#include "app/sim/solids/angles.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

/// A piece of furniture with the things on it: Room::solids from `begin` up to `end`.
struct Piece {
  std::size_t begin = 0, end = 0;
  Vector3d along = Vector3d::Zero();  ///< direction of the wall that it stands at; zero: it stands free
};

/// A room under construction: volumes kept free, and the random numbers it is drawn from.
struct Furnishing {
  Room room;
  std::vector<Solid> kept_free;
  CounterRandom random;
  std::uint32_t next_look = 1000;
  std::vector<Piece> pieces;  ///< in the order of Room::solids

  /// Adds a piece that consists of what `furnish` puts into the room.
  void add_piece(const Vector3d& along, const std::function<void()>& furnish) {
    const std::size_t begin = room.solids.size();
    furnish();
    if (room.solids.size() > begin) pieces.push_back({begin, room.solids.size(), along});
  }

  Material material(Pattern pattern, double darkest = 0.35) {
    const double light = random.uniform(darkest, 0.95), warm = random.uniform(-0.12, 0.12);
    const auto part = [](double of) { return static_cast<std::uint8_t>(255.0 * std::clamp(of, 0.0, 1.0)); };
    const Rgb first{part(light + warm), part(light), part(light - warm)};
    const Rgb second{part(0.65 * (light + warm)), part(0.65 * light), part(0.65 * (light - warm))};
    return {pattern, first, second, ++next_look, static_cast<float>(random.uniform(0.4, 0.7))};
  }
  std::uint32_t look() { return ++next_look; }

  /// Adds a piece unless it would touch anything except its support.
  bool try_add(const std::function<void(Room&)>& put_down) {
    constexpr double kLift_m = 0.002, kGap_m = 0.001;
    Room piece;
    put_down(piece);
    std::vector<Solid> lifted = piece.solids;
    for (Solid& solid : lifted) solid.T_world_solid.pretranslate(Vector3d(0, 0, kLift_m));
    const auto world = Eigen::Isometry3d::Identity();
    if (clearance_m(room.solids, lifted, world, kGap_m) < kGap_m) return false;
    if (clearance_m(kept_free, piece.solids, world, kGap_m) < kGap_m) return false;
    room.solids.insert(room.solids.end(), piece.solids.begin(), piece.solids.end());
    room.materials.insert(room.materials.end(), piece.materials.begin(), piece.materials.end());
    return true;
  }
};

/// Puts small objects on a horizontal board of this size, centred at T_world_board.
void put_things_on(Furnishing& f, const Eigen::Isometry3d& T_world_board, double wide_m, double deep_m,
                   int count) {
  constexpr double kMargin_m = 0.16;
  for (int i = 0; i < count; ++i) {
    const double x = f.random.uniform(-1.0, 1.0) * std::max(0.0, 0.5 * wide_m - kMargin_m);
    const double y = f.random.uniform(-1.0, 1.0) * std::max(0.0, 0.5 * deep_m - kMargin_m);
    const Eigen::Isometry3d T_world_thing =
        T_world_board * standing_at(x, y, 0.0, f.random.uniform(0.0, kFullTurn_rad));
    const double kind = f.random.uniform();
    const std::uint32_t look = f.look();
    const Material paper = f.material(Pattern::kPoster), tiles = f.material(Pattern::kTiles);
    const double size_z = f.random.uniform(0.03, 0.28), size_y = f.random.uniform(0.05, 0.2),
                 size_x = f.random.uniform(0.06, 0.24);
    const Vector3d size(size_x, size_y, size_z);
    const int books = 1 + static_cast<int>(4.0 * f.random.uniform());
    f.try_add([&](Room& room) {
      if (kind < 0.25) {
        add_book_pile(room, T_world_thing, books, look);
      } else if (kind < 0.45) {
        add_mug(room, T_world_thing, tiles);
      } else if (kind < 0.55) {
        add_cactus(room, T_world_thing);
      } else if (kind < 0.65) {
        add_fruit_plate(room, T_world_thing);
      } else {
        add(room, T_world_thing, box({0, 0, 0.5 * size.z()}, size), paper);
      }
    });
  }
}

/// Furnishes the centre with a table and chairs, a sofa and a low table, or crates; sets where movers may go.
void furnish_middle(Furnishing& f) {
  const Vector3d kFree = Vector3d::Zero();  // stands at no wall
  const double kind = f.random.uniform(), yaw_rad = f.random.uniform(-0.3, 0.3);
  const Material wood = f.material(Pattern::kWood), cloth = f.material(Pattern::kFabric);
  const double board_z = f.random.uniform(0.68, 0.78), board_y = f.random.uniform(0.7, 0.95),
               board_x = f.random.uniform(1.0, 1.7);
  Vector3d board_m(board_x, board_y, board_z);
  if (kind >= 0.5)
    board_m = {f.random.uniform(0.6, 1.1), f.random.uniform(0.5, 0.7), f.random.uniform(0.35, 0.5)};
  const double middle_y = f.random.uniform(-0.15, 0.15), middle_x = f.random.uniform(-0.3, 0.3);
  const Eigen::Isometry3d T_world_middle = standing_at(middle_x, middle_y, 0.0, yaw_rad);
  const Eigen::Isometry3d T_world_board = T_world_middle * standing_at(0, 0, board_m.z());
  f.room.focus_world = T_world_board * Vector3d(0.0, -0.5 * board_m.y() + 0.2, 0.0);
  f.add_piece(kFree, [&] {
    if (kind < 0.75) {
      f.try_add([&](Room& room) { add_table(room, T_world_middle, board_m, wood); });
    } else {
      f.try_add([&](Room& room) {
        add(room, T_world_middle, box({0, 0, 0.5 * board_m.z()}, board_m), f.material(Pattern::kPlanks));
      });
    }
    f.kept_free.push_back(cylinder(f.room.focus_world + Vector3d(0, 0, 0.001), 0.13, 0.65));
    put_things_on(f, T_world_board, board_m.x(), board_m.y(), 9);
  });
  if (kind < 0.5) {
    for (const double side : {-1.0, 1.0})
      for (double x = -0.5 * board_m.x() + 0.35; x < 0.5 * board_m.x(); x += 0.62) {
        if (f.random.uniform() < 0.2) continue;
        const double turn_rad = f.random.uniform(-0.3, 0.3), away_m = f.random.uniform(0.1, 0.35),
                     aside_m = f.random.uniform(-0.05, 0.05);
        const Eigen::Isometry3d T_world_chair =
            T_world_middle * standing_at(x + aside_m, side * (0.5 * board_m.y() + away_m), 0.0,
                                         (side > 0.0 ? std::numbers::pi : 0.0) + turn_rad);
        f.add_piece(kFree,
                    [&] { f.try_add([&](Room& room) { add_chair(room, T_world_chair, wood, cloth); }); });
      }
  } else if (kind < 0.75) {
    f.add_piece(kFree, [&] {
      f.try_add([&](Room& room) {
        const Material cushions = f.material(Pattern::kFabric);
        const double wide_m = f.random.uniform(1.7, 2.1);
        add_sofa(room, T_world_middle * standing_at(0.0, 0.5 * board_m.y() + 0.75, 0.0, 0.0), wide_m, cloth,
                 cushions);
      });
    });
  } else {
    for (int i = 0; i < 3; ++i) {
      const double size_z = f.random.uniform(0.2, 0.7), size_y = f.random.uniform(0.25, 0.5),
                   size_x = f.random.uniform(0.25, 0.6);
      const Vector3d size(size_x, size_y, size_z);
      const double turn_rad = f.random.uniform(0.0, kFullTurn_rad), y = f.random.uniform(-0.8, 0.8),
                   x = f.random.uniform(-1.2, 1.2);
      const Eigen::Isometry3d T_world_crate = standing_at(x, y, 0.0, turn_rad);
      const Material planks = f.material(Pattern::kPlanks);
      f.add_piece(kFree, [&] {
        f.try_add([&](Room& room) { add(room, T_world_crate, box({0, 0, 0.5 * size.z()}, size), planks); });
      });
    }
  }
}

/// Adds a random piece of furniture or picture at a random position along a wall. Wall i is rotated by i
/// quarter turns; -y of the wall's frame points into the room.
void furnish_wall(Furnishing& f, int wall) {
  const Vector3d half = 0.5 * (f.room.interior_max_world - f.room.interior_min_world);
  const bool along_x = wall % 2 == 0;
  const double length_m = along_x ? half.x() : half.y(), away_m = along_x ? half.y() : half.x();
  const double width_m = f.random.uniform(0.6, 1.5),
               shift_m = f.random.uniform(-1.0, 1.0) * (length_m - 0.5 * width_m - 0.05);
  const Eigen::Isometry3d T_world_wall =
      standing_at(0, 0, 0, -0.5 * std::numbers::pi * wall) * standing_at(shift_m, away_m, 0);
  const double kind = f.random.uniform(), high_m = f.random.uniform(0.4, 1.9);
  const Material wood = f.material(Pattern::kWood), cloth = f.material(Pattern::kFabric),
                 paper = f.material(Pattern::kPoster);
  const std::uint32_t look = f.look();
  constexpr double kGap_m = 0.01;  // between a piece and the wall
  const auto before_wall = [&](double deep_m) {
    return T_world_wall * standing_at(0, -0.5 * deep_m - kGap_m, 0);
  };
  if (kind < 0.3) {
    const int levels = std::max(1, static_cast<int>(high_m / 0.36));
    if (f.try_add([&](Room& room) {
          add_shelf(room, before_wall(0.3), {width_m, 0.3, std::max(high_m, 0.5)}, levels, wood, look);
        }) &&
        high_m < 1.2)
      put_things_on(f, before_wall(0.3) * standing_at(0, 0, std::max(high_m, 0.5)), width_m, 0.33, 3);
  } else if (kind < 0.5) {
    const double top_m = std::min(high_m + 0.2, 1.1);
    if (f.try_add([&](Room& room) { add_cupboard(room, before_wall(0.45), {width_m, 0.4, top_m}, wood); }))
      put_things_on(f, before_wall(0.45) * standing_at(0, 0, top_m), width_m, 0.4, 4);
  } else if (kind < 0.62) {
    const double deep_m = f.random.uniform(0.4, 0.6), top_m = f.random.uniform(0.45, 0.78);
    if (f.try_add([&](Room& room) { add_table(room, before_wall(deep_m), {width_m, deep_m, top_m}, wood); }))
      put_things_on(f, before_wall(deep_m) * standing_at(0, 0, top_m), width_m, deep_m, 4);
  } else if (kind < 0.7) {
    f.try_add([&](Room& room) { add_floor_lamp(room, before_wall(0.4)); });
  } else if (kind < 0.78) {
    f.try_add([&](Room& room) { add_chair(room, before_wall(0.5), wood, cloth); });
  } else {
    f.try_add([&](Room& room) {
      add_picture(room, T_world_wall * standing_at(0, -kGap_m, 1.5), 0.7 * width_m, 0.55 * width_m, paper,
                  wood);
    });
  }
}

/// Moves this share of the pieces of furniture, with what is on them, by 0.3 m or more. Takes away those that
/// fit nowhere else. The random numbers are others than those of the furniture.
void move_furniture(Furnishing& f, double share, std::uint64_t seed) {
  constexpr double kNearest_m = 0.3, kFarthest_m = 1.6, kMostTurn_rad = 0.6;
  constexpr int kTries = 100;
  CounterRandom random(seed, 0x6d6f7665);
  std::vector<Piece> chosen = f.pieces;
  const auto count =
      static_cast<std::size_t>(std::ceil(std::min(share, 1.0) * static_cast<double>(chosen.size())));
  while (chosen.size() > count)
    chosen.erase(chosen.begin() +
                 static_cast<std::ptrdiff_t>(random.uniform() * static_cast<double>(chosen.size())));

  struct Taken {
    std::vector<Solid> solids;
    std::vector<Material> materials;
    Vector3d along;
  };
  std::vector<Taken> taken;
  const auto take_out = [](auto& all, const Piece& piece) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(piece.begin);
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(piece.end);
    const std::remove_reference_t<decltype(all)> out(begin, end);
    all.erase(begin, end);
    return out;
  };
  for (auto piece = chosen.rbegin(); piece != chosen.rend(); ++piece)  // so that indices before it stay valid
    taken.push_back({take_out(f.room.solids, *piece), take_out(f.room.materials, *piece), piece->along});

  const Eigen::AlignedBox3d interior(f.room.interior_min_world, f.room.interior_max_world);
  for (const Taken& piece : taken) {
    Vector3d centre = Vector3d::Zero();
    for (const Solid& solid : piece.solids)
      centre += solid.T_world_solid.translation() / static_cast<double>(piece.solids.size());
    for (int i = 0; i < kTries; ++i) {
      const double way = random.uniform(kNearest_m, kFarthest_m), side = random.uniform() < 0.5 ? -1.0 : 1.0;
      const double azimuth_rad = random.uniform(0.0, kFullTurn_rad),
                   turn_rad = random.uniform(-kMostTurn_rad, kMostTurn_rad);
      const bool is_free = piece.along.isZero();
      const Vector3d shift =
          way * (is_free ? Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0) : side * piece.along);
      if (!interior.contains(centre + shift)) continue;
      const Eigen::Isometry3d T_new_old = Eigen::Translation3d(centre + shift) *
                                          Eigen::AngleAxisd(is_free ? turn_rad : 0.0, Vector3d::UnitZ()) *
                                          Eigen::Translation3d(-centre);
      const bool fits = f.try_add([&](Room& room) {
        room.solids = piece.solids;
        room.materials = piece.materials;
        for (Solid& solid : room.solids) solid.T_world_solid = T_new_old * solid.T_world_solid;
      });
      if (fits) break;
    }
  }
}

void keep_doorways_free(Furnishing& f, const Vector3d& half, std::span<const Doorway> doorways) {
  constexpr double kDeep_m = 1.0, kAside_m = 0.1;
  const std::array<Vector3d, 4> outwards{Vector3d::UnitY(), -Vector3d::UnitY(), -Vector3d::UnitX(),
                                         Vector3d::UnitX()};
  for (const Doorway& door : doorways) {
    const Vector3d out = outwards[door.wall], right(out.y(), -out.x(), 0.0);
    const double away_m = std::abs(out.dot(half)) - 0.5 * kDeep_m;
    const Vector3d size = kDeep_m * out.cwiseAbs() + (door.width_m + 2.0 * kAside_m) * right.cwiseAbs();
    f.kept_free.push_back(
        box(away_m * out + door.centre_m * right + Vector3d(0, 0, 1.0), size + Vector3d(0, 0, 1.99)));
  }
}

}  // namespace

// Every random value is drawn into a variable of its own statement: the evaluation order of function
// arguments depends on the compiler.
Room make_random_room(std::uint64_t seed, const RandomRoomShape& shape) {
  Furnishing f{{}, {}, CounterRandom(seed, 0x726f6f6d), 1000, {}};
  Room& room = f.room;
  room.name = kRandomRoom;
  const double half_y = f.random.uniform(2.3, 2.8), half_x = f.random.uniform(2.5, 3.2);
  const Eigen::Vector2d size = shape.half_m.value_or(Eigen::Vector2d(half_x, half_y));
  const Vector3d half(size.x(), size.y(), 0.0);
  room.interior_min_world = -half;
  room.interior_max_world = half + Vector3d(0, 0, f.random.uniform(2.4, 2.8));
  const std::array floors{Pattern::kPlanks, Pattern::kTiles, Pattern::kStone};
  const Material ceiling = f.material(Pattern::kPlaster, 0.7), walls = f.material(Pattern::kPlaster, 0.6),
                 floor = f.material(floors[static_cast<std::size_t>(3.0 * f.random.uniform())]);
  add_shell(room, floor, walls, ceiling, shape.doorways);
  keep_doorways_free(f, half, shape.doorways);

  room.walk_centre_world = {0.0, 0.0, 1.5};
  room.walk_half_m = {half.x() - 1.05, half.y() - 1.0};
  // A free strip of floor between the centre and one wall, for a walking person and a rolling ball.
  const double lane_y = (f.random.uniform() < 0.5 ? -1.0 : 1.0) * (half.y() - 0.95);
  room.person_from_world = {-0.35 * half.x(), lane_y, 0.0};
  room.person_to_world = {0.35 * half.x(), lane_y, 0.0};
  room.ball_from_world = room.person_from_world;
  room.ball_to_world = room.person_to_world;
  constexpr double kLane_m = 0.42;
  f.kept_free.push_back(box({0.0, lane_y, 1.0}, {0.7 * half.x() + 2.0 * kLane_m, 2.0 * kLane_m, 1.99}));

  furnish_middle(f);
  const int pieces = 10 + static_cast<int>(8.0 * f.random.uniform());
  for (int i = 0; i < pieces; ++i) {
    const bool along_x = i % 2 == 0;
    f.add_piece(along_x ? Vector3d::UnitX() : Vector3d::UnitY(), [&] { furnish_wall(f, i % 4); });
  }
  if (shape.moved > 0.0) move_furniture(f, shape.moved, seed);

  room.view_azimuth_rad = -0.5 * std::numbers::pi;
  room.lamps = {{{-0.4 * half.x(), 0.0, room.interior_max_world.z() - 0.2}, 2.4F, 0.25},
                {{0.4 * half.x(), 0.3, room.interior_max_world.z() - 0.2}, 2.4F, 0.25}};
  return std::move(f.room);
}

namespace {

using Eigen::Vector2d;

const Vector2d kHalf_m(2.75, 2.5);
constexpr double kQuarter_rad = 0.5 * std::numbers::pi;

/// Appends the walk through one room: in through one doorway, three quarters of the ellipse, and half way to
/// the next room.
/// @param in_rad  azimuth, from the room's middle, of the doorway into the room; the doorway out is a quarter
///                turn before it, counter-clockwise
/// @param yaw_rad  in: azimuth of the view in the doorway. out: the same for the next room
void walk_through(const Vector2d& middle, const Vector2d& half_m, double in_rad, double& yaw_rad,
                  std::vector<WalkPoint>& walk) {
  constexpr int kSteps = 9;  // along the ellipse
  constexpr double kStep_rad = 3.0 * kQuarter_rad / kSteps;
  constexpr int kTurnSteps = 5;  // steps at each end of the way out over which the view turns round
  const double out_rad = in_rad + 3.0 * kQuarter_rad;
  const Vector2d out(std::round(std::cos(out_rad)), std::round(std::sin(out_rad)));
  for (int i = 0; i <= kSteps; ++i) {
    const double angle_rad = in_rad + kStep_rad * i;
    const double turned = std::max(0, i - (kSteps - kTurnSteps));
    walk.push_back({middle + half_m.cwiseProduct(Vector2d(std::cos(angle_rad), std::sin(angle_rad))),
                    yaw_rad + kStep_rad * i + turned * kQuarter_rad / kTurnSteps});
  }
  const double last_rad = walk.back().yaw_rad;
  const Vector2d way = kHalf_m + Vector2d::Constant(kShellThickness_m) - half_m;
  for (int i = 1; i <= 2; ++i) {
    const double part = i / 2.0;
    walk.push_back({middle + out.cwiseProduct(half_m + part * way), last_rad + part * kQuarter_rad});
  }
  const double ahead = walk.back().yaw_rad;
  walk.push_back({middle + out.cwiseProduct(half_m + 1.5 * way), ahead});
  yaw_rad = ahead;
}

}  // namespace

Room make_flat(std::uint64_t seed) {
  Room flat;
  const Vector2d pitch = kHalf_m + Vector2d::Constant(kShellThickness_m);
  const std::array<Vector2d, 4> middles{Vector2d(-pitch.x(), -pitch.y()), Vector2d(pitch.x(), -pitch.y()),
                                        pitch, Vector2d(-pitch.x(), pitch.y())};
  // Walls with a doorway, as in Doorway::wall: room i leads to room i + 1 and back to room i - 1.
  constexpr unsigned kDoorways[4][2] = {{0, 3}, {0, 2}, {1, 2}, {1, 3}};
  constexpr std::uint32_t kLooks = 10'000;  // more than the materials of a room
  double yaw_rad = -kQuarter_rad;
  for (std::size_t i = 0; i < 4; ++i) {
    Room room = make_random_room(hash_of(seed, i), {kHalf_m, {{kDoorways[i][0]}, {kDoorways[i][1]}}});
    const Eigen::Vector3d shift(middles[i].x(), middles[i].y(), 0.0);
    for (Solid& solid : room.solids) solid.T_world_solid.pretranslate(shift);
    for (Material& material : room.materials) material.seed += kLooks * static_cast<std::uint32_t>(i);
    for (Lamp& lamp : room.lamps) lamp.position_world += shift;
    flat.solids.insert(flat.solids.end(), room.solids.begin(), room.solids.end());
    flat.materials.insert(flat.materials.end(), room.materials.begin(), room.materials.end());
    flat.lamps.insert(flat.lamps.end(), room.lamps.begin(), room.lamps.end());
    flat.interior_max_world = flat.interior_max_world.cwiseMax(room.interior_max_world + shift);
    walk_through(middles[i], room.walk_half_m, kQuarter_rad * (1.0 + static_cast<double>(i)), yaw_rad,
                 flat.walk);
    if (i > 0) continue;
    flat.focus_world = room.focus_world + shift;
    flat.view_azimuth_rad = room.view_azimuth_rad;
    flat.walk_centre_world = room.walk_centre_world + shift;
    flat.walk_half_m = room.walk_half_m;
    flat.ball_from_world = room.ball_from_world + shift;
    flat.ball_to_world = room.ball_to_world + shift;
    flat.person_from_world = room.person_from_world + shift;
    flat.person_to_world = room.person_to_world + shift;
    flat.interior_min_world = room.interior_min_world + shift;
  }
  flat.walk_turns = static_cast<int>(std::lround((yaw_rad + kQuarter_rad) / kFullTurn_rad));
  flat.name = kFlatRoom;
  return flat;
}

}  // namespace roomradar
