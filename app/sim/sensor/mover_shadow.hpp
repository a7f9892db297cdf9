// mover_shadow.hpp: the shadow that moving things throw on the room, which the baked light does not have.
#pragma once
#include <span>
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Shadows of one frame's moving solids from the room's first lamp, the strongest.
class MoverShadow {
 public:
  void prepare(std::span<const Solid> movers);

  /// Factor on the colour of a point on the room's surface: 1 in the open and in the room's own shadow, about
  /// 0.75 where things that move hide the lamp.
  [[nodiscard]] float factor(const Room& room, const Eigen::Vector3d& p_world,
                             const Eigen::Vector3d& normal_world) const;

 private:
  std::vector<Solid> movers_;
  SolidTree tree_;
};

}  // namespace roomradar
