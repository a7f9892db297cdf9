// furniture.hpp: adds furniture to a simulated room. Each piece's origin is on its supporting surface.
#pragma once
#include <cstdint>
#include <span>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Returns the pose of an upright piece of furniture with its origin at (x_m, y_m, z_m), rotated by yaw_rad
/// about z.
Eigen::Isometry3d standing_at(double x_m, double y_m, double z_m, double yaw_rad = 0.0);

/// Adds a solid whose pose is given in the frame of a piece of furniture.
void add(Room& room, const Eigen::Isometry3d& T_world_piece, Solid solid_piece, const Material& material);

/// Size of a doorway, m.
inline constexpr double kDoorwayWidth_m = 1.3, kDoorwayHeight_m = 2.1;
/// Thickness of floor, ceiling and walls, m.
inline constexpr double kShellThickness_m = 0.1;
/// A doorway of a room, kDoorwayHeight_m high.
struct Doorway {
  unsigned wall = 0;      ///< 0 to 3: the wall at +y, -y, -x or +x
  double centre_m = 0.0;  ///< from the wall's middle, to the right as seen from inside
  double width_m = kDoorwayWidth_m;
};
/// Adds floor, ceiling and four walls around the room's interior.
/// @param doorways  at most one per wall
void add_shell(Room& room, const Material& floor, const Material& wall, const Material& ceiling,
               std::span<const Doorway> doorways = {});

/// Adds a thin framed picture to a wall. The origin of T_world_picture is the centre of the picture's back; x
/// points to the viewer's right, z up, and -y into the room.
void add_picture(Room& room, const Eigen::Isometry3d& T_world_picture, double width_m, double height_m,
                 const Material& picture, const Material& frame);

/// Adds a table with bounding box size_m.
void add_table(Room& room, const Eigen::Isometry3d& T_world_table, const Eigen::Vector3d& size_m,
               const Material& material);
/// Adds a chair that faces +y, with a seat height of 0.45 m and a total height of 0.9 m.
void add_chair(Room& room, const Eigen::Isometry3d& T_world_chair, const Material& wood,
               const Material& cushion);
/// Adds a shelf with its open front towards -y and `levels` boards. The seed determines the books and boxes
/// on the boards.
void add_shelf(Room& room, const Eigen::Isometry3d& T_world_shelf, const Eigen::Vector3d& size_m, int levels,
               const Material& wood, std::uint32_t seed);
/// Adds a closed cupboard with two doors that faces -y.
void add_cupboard(Room& room, const Eigen::Isometry3d& T_world_cupboard, const Eigen::Vector3d& size_m,
                  const Material& wood);
/// Adds a sofa that faces -y.
void add_sofa(Room& room, const Eigen::Isometry3d& T_world_sofa, double width_m, const Material& fabric,
              const Material& pillow);
/// Adds a pile of `books` flat books, the largest at the bottom. Each book is slightly rotated.
void add_book_pile(Room& room, const Eigen::Isometry3d& T_world_pile, int books, std::uint32_t seed);
void add_mug(Room& room, const Eigen::Isometry3d& T_world_mug, const Material& material);
void add_cactus(Room& room, const Eigen::Isometry3d& T_world_pot);
void add_fruit_plate(Room& room, const Eigen::Isometry3d& T_world_plate);
void add_floor_lamp(Room& room, const Eigen::Isometry3d& T_world_lamp);

}  // namespace roomradar
