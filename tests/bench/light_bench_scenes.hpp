// light_bench_scenes.hpp: simulated rooms under chosen lamps, with and without a real object, and their
// pictures.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/room/surface_appearance.hpp"
#include "app/sim/sensor/kinect_depth.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Lamps of a room.
struct LampSet {
  std::string name;
  /// True: one lamp at a side wall instead of the room's own, of warm colour.
  bool from_the_side = false;
};

/// A room under lamps, with the colours of its surfaces. Not movable: the appearance refers to the room.
struct LitRoom {
  Room room;
  std::size_t object_begin = 0;  ///< index of the object's first solid; the number of solids if there is none
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();  ///< factor on linear red, green and blue
  std::unique_ptr<SurfaceAppearance> look;

  LitRoom() = default;
  LitRoom(const LitRoom&) = delete;
  LitRoom& operator=(const LitRoom&) = delete;
};

/// The object of the benchmark: a box, a cylinder on it and a ball on that, 0.27 m high, each in its colour.
/// Its origin is the centre of its foot.
std::vector<Solid> object_solids();
std::vector<Material> object_materials();
Mesh object_of_solids();

/// @param foot_room  where the object stands; unset: without the object
std::unique_ptr<LitRoom> lit_room(const std::string& name, const LampSet& lamps,
                                  const std::optional<Eigen::Vector3d>& foot_room);

/// Direction from p_room of the lamps' light that arrives there, unit. Unset if no lamp is visible from
/// there, or if the lamps' light comes from all around.
std::optional<Eigen::Vector3d> true_light(const LitRoom& lit, const Eigen::Vector3d& p_room);

/// Renders colour and exact depth.
/// @param noise  standard deviation of brightness, of 255
void render_lit(const LitRoom& lit, const Intrinsics& camera, const Eigen::Isometry3d& T_room_camera,
                double noise, std::uint64_t noise_seed, ColourImage& colour, ExactView& exact);

/// Draws camera poses 0.7 to 1.6 m from the object's middle that look at it from above without anything in
/// between. Deterministic in `seed`.
std::vector<Eigen::Isometry3d> views_of(const Room& room, const Eigen::Vector3d& foot_room, std::size_t count,
                                        std::uint64_t seed);

}  // namespace roomradar
