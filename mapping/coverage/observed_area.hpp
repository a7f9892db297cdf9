// observed_area.hpp: estimates how much surface a running scan has observed.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_set>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Counts cells of 10 cm that contain measured surface. Uses every 16th pixel in both directions, up to 4 m
/// depth. A cell counts as 0.01 m2. The area is about right for surface along the world frame's axes, and up
/// to 1.7 times too large for diagonal surface. Takes about 50 microseconds per frame. If poses drift,
/// surface that is seen again later may count twice.
class ObservedArea {
 public:
  void add(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  [[nodiscard]] double total_m2() const;
  /// Returns the area added during the last second, by the frames' time stamps.
  [[nodiscard]] double last_second_m2() const;

 private:
  struct Gain {
    double stamp_s = 0.0;
    std::size_t cells = 0;
  };
  std::unordered_set<std::uint64_t> cells_;
  std::deque<Gain> last_second_;
};

/// Returns text such as "12.4 m2 seen, 0.30 of it in the last second".
std::string describe(const ObservedArea& seen);

}  // namespace roomradar
