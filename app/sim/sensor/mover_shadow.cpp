// mover_shadow.cpp: casts rays to a few points of the lamp.
#include "app/sim/sensor/mover_shadow.hpp"

#include <iterator>

namespace roomradar {

void MoverShadow::prepare(std::span<const Solid> movers) {
  movers_.assign(movers.begin(), movers.end());
  tree_ = SolidTree(movers_);
}

float MoverShadow::factor(const Room& room, const Eigen::Vector3d& p_world,
                          const Eigen::Vector3d& normal_world) const {
  constexpr double kLampPoints[4][2] = {{0.6, 0.2}, {-0.2, 0.6}, {-0.6, -0.2}, {0.2, -0.6}};
  constexpr float kDarkest = 0.26F;
  constexpr double kSkin_m = 0.001;
  if (room.lamps.empty()) return 1.0F;
  const Lamp& lamp = room.lamps.front();
  if (normal_world.dot(lamp.position_world - p_world) <= 0.0) return 1.0F;
  const Eigen::Vector3d start_world = p_world + kSkin_m * normal_world;
  int blocked = 0;
  for (const auto& [x, y] : kLampPoints)
    blocked += tree_.is_blocked(movers_, start_world,
                                lamp.position_world + lamp.radius_m * Eigen::Vector3d(x, y, 0.0));
  if (blocked == 0 || room.tree.is_blocked(room.solids, start_world, lamp.position_world)) return 1.0F;
  return 1.0F - kDarkest * static_cast<float>(blocked) / static_cast<float>(std::size(kLampPoints));
}

Rgb dimmed(Rgb colour, float factor) {
  const auto dim = [factor](std::uint8_t of) {
    return static_cast<std::uint8_t>(static_cast<float>(of) * factor);
  };
  return factor < 1.0F ? Rgb{dim(colour.r), dim(colour.g), dim(colour.b)} : colour;
}

}  // namespace roomradar
