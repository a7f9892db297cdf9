// furniture.hpp: adds furniture to a simulated room. Each piece's origin is on the surface that carries it.
#pragma once
#include <cstdint>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Returns the pose of an upright piece of furniture: its origin at a point, rotated by yaw_rad about z.
Eigen::Isometry3d standing_at(double x_m, double y_m, double z_m, double yaw_rad = 0.0);

/// Adds a solid whose pose is given in the frame of a piece of furniture.
void add(Room& room, const Eigen::Isometry3d& T_world_piece, Solid solid_piece, const Material& material);

/// Adds floor, ceiling and four walls, 10 cm thick, around the room's interior, with skirting boards.
void add_shell(Room& room, const Material& floor, const Material& wall, const Material& ceiling);

/// Adds a thin framed picture to a wall. The pose's origin is the centre of the picture's back; x points to
/// the viewer's right, z up, -y into the room.
void add_picture(Room& room, const Eigen::Isometry3d& T_world_picture, double width_m, double height_m,
                 const Material& picture, const Material& frame);

/// Adds a table of this size.
void add_table(Room& room, const Eigen::Isometry3d& T_world_table, const Eigen::Vector3d& size_m,
               const Material& material);
/// Adds a chair that faces +y, with its seat at 0.45 m and a back up to 0.9 m.
void add_chair(Room& room, const Eigen::Isometry3d& T_world_chair, const Material& wood,
               const Material& cushion);
/// Adds a shelf with its open front towards -y and `levels` boards. Books and boxes on the boards are drawn
/// at random from the seed.
void add_shelf(Room& room, const Eigen::Isometry3d& T_world_shelf, const Eigen::Vector3d& size_m, int levels,
               const Material& wood, std::uint32_t seed);
/// Adds a closed cupboard with two doors; its front faces -y.
void add_cupboard(Room& room, const Eigen::Isometry3d& T_world_cupboard, const Eigen::Vector3d& size_m,
                  const Material& wood);
/// Adds a sofa that faces -y.
void add_sofa(Room& room, const Eigen::Isometry3d& T_world_sofa, double width_m, const Material& fabric,
              const Material& pillow);
/// Adds a pile of books that lie flat, the largest at the bottom, each slightly rotated.
void add_book_pile(Room& room, const Eigen::Isometry3d& T_world_pile, int books, std::uint32_t seed);
void add_mug(Room& room, const Eigen::Isometry3d& T_world_mug, const Material& material);
void add_cactus(Room& room, const Eigen::Isometry3d& T_world_pot);
void add_fruit_plate(Room& room, const Eigen::Isometry3d& T_world_plate);
void add_floor_lamp(Room& room, const Eigen::Isometry3d& T_world_lamp);

}  // namespace roomradar
