// mover_shadow.hpp: shadows of moving objects, added to the precomputed lighting.
#pragma once
#include <span>
#include <vector>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Shadows of one frame's moving solids in the light of the room's first and strongest lamp.
class MoverShadow {
 public:
  void prepare(std::span<const Solid> movers);

  /// Returns the brightness factor of a point on the room's surface. It is about 0.75 if a moving solid
  /// blocks the lamp, and 1 if the lamp lights the point or the room itself shadows it.
  [[nodiscard]] float factor(const Room& room, const Eigen::Vector3d& p_world,
                             const Eigen::Vector3d& normal_world) const;

 private:
  std::vector<Solid> movers_;
  SolidTree tree_;
};

/// Returns the colour with each channel multiplied by the factor, <= 1.
Rgb dimmed(Rgb colour, float factor);

}  // namespace roomradar
