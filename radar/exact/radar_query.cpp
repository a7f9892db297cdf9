// radar_query.cpp: checks settings and queries.
#include "radar/exact/radar_query.hpp"

#include <cmath>
#include <limits>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void require_valid(const RadarConfig& config) {
  const ConfigCheck require{"radar"};
  require(config.resolution_px >= 1 && config.resolution_px <= 4096, "resolution_px", config.resolution_px,
          "in 1..4096");
}

bool is_valid(const RadarQuery& q) {
  return q.direction_world.allFinite() && q.direction_world.stableNorm() > 0.0 && q.distance_m > 0.0 &&
         std::isfinite(q.distance_m) && q.margin_m >= 0.0 && std::isfinite(q.margin_m) &&
         q.object.tree != nullptr && !q.object.tree->empty() && q.object.T_world_mesh.matrix().allFinite();
}

double touching_m(const TriangleTree& object) {
  return 1e-6 + 2.0 * std::numeric_limits<float>::epsilon() * object.half_size().cast<double>().norm();
}

}  // namespace roomradar
