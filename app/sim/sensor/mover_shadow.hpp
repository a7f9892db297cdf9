// mover_shadow.hpp: shadows of moving objects, in addition to the precomputed lighting.
#pragma once
#include <span>
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Shadows that one frame's moving solids cast from the room's first and strongest lamp.
class MoverShadow {
 public:
  void prepare(std::span<const Solid> movers);

  /// Returns the factor on the colour of a point on the room's surface: about 0.75 if a moving solid blocks
  /// the lamp; 1 if the point is lit, or already in the room's own shadow.
  [[nodiscard]] float factor(const Room& room, const Eigen::Vector3d& p_world,
                             const Eigen::Vector3d& normal_world) const;

 private:
  std::vector<Solid> movers_;
  SolidTree tree_;
};

}  // namespace roomradar
