// object_light.hpp: how much light the room's surfaces leave for an object, and for points on them.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/render/room_light.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Casts rays at the room's surfaces: towards lamps in each direction, from four points half a radius from
/// the middle, and 16 upwards, cosine weighted, up to 1 m. A surface takes a lamp's light if it is nearer
/// than 0.8 m, and none beyond 1.3 m: ceilings and walls are behind the lamps. Nearer surfaces take more of
/// the ambient light. All fractions are 1 without surfaces, and for values that are not finite.
/// @param room          the room's surfaces; may be null or empty
/// @param middle_world  centre of the object
/// @param radius_m      radius of its bounding sphere
LightReach light_reach(const TreeInstance& room, const Eigen::Vector3d& middle_world, double radius_m);

/// The same for a point on a surface of the room: ambient light arrives from the side of the normal, and is
/// taken by surfaces within 0.5 m; lamps are 3 m from `place_world`.
LightReach surface_reach(const TreeInstance& room, const Eigen::Vector3d& p_world,
                         const Eigen::Vector3d& normal_world, const Eigen::Vector3d& place_world);

/// The light that the room leaves for each object, smoothed over time.
class ObjectReaches {
 public:
  /// Determines it for objects that were placed since the last call, and for one other object in turn: one
  /// that moved by more than 3 cm, or whose light was determined more than two seconds ago.
  /// @param renewed  fraction of the smoothed values that is new
  void update(std::span<const std::unique_ptr<VirtualObject>> objects, const TreeInstance& room, double dt_s,
              float renewed);
  /// Returns null for an object that was not in the room at the last update.
  [[nodiscard]] const LightReach* of(std::size_t object) const {
    return object < entries_.size() && entries_[object] ? &entries_[object]->smooth : nullptr;
  }

 private:
  struct Entry {
    LightReach now, smooth;
    Eigen::Vector3d middle_world = Eigen::Vector3d::Zero();  ///< where `now` was determined
    double age_s = 0.0;
  };
  std::vector<std::optional<Entry>> entries_;
  std::size_t last_ = 0;  ///< index of the object whose turn it was last
};

}  // namespace roomradar
