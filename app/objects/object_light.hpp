// object_light.hpp: fractions of light that the room's surfaces do not occlude at an object or surface point.
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

/// Casts rays against the room's surfaces. For lamps, casts rays in each of lamp_directions() from four
/// points half a radius from the middle. For ambient light, casts 16 cosine-weighted rays upwards, up to 1 m.
/// A surface nearer than 0.8 m blocks a lamp's ray. A surface beyond 1.3 m does not, since ceilings and walls
/// are behind the lamps. Between these distances, the fraction that passes increases linearly. Surfaces block
/// up to 60 % of the ambient light; nearer surfaces block more. All fractions are 1 without surfaces, and for
/// values that are not finite.
/// @param room          the room's surfaces; may be null or empty
/// @param middle_world  centre of the object
/// @param radius_m      radius of its bounding sphere
LightReach light_reach(const TreeInstance& room, const Eigen::Vector3d& middle_world, double radius_m);

/// Returns the fractions for a point on a surface of the room. Ambient light arrives from the side of the
/// normal, and surfaces within 0.5 m block it. The lamp of each direction is assumed 3 m from `place_world`,
/// the place for which light is estimated.
LightReach surface_reach(const TreeInstance& room, const Eigen::Vector3d& p_world,
                         const Eigen::Vector3d& normal_world, const Eigen::Vector3d& place_world);

/// Light reach of each object, smoothed over time.
class ObjectReaches {
 public:
  /// Computes the reach of objects that were placed since the last call. Also recomputes it for one other
  /// object, in turn, that moved by more than 3 cm or whose reach is older than two seconds.
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
    Eigen::Vector3d middle_world = Eigen::Vector3d::Zero();  ///< where `now` was computed
    double age_s = 0.0;
  };
  std::vector<std::optional<Entry>> entries_;
  std::size_t last_ = 0;  ///< index of the object whose turn it was last
};

}  // namespace roomradar
