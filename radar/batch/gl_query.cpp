// gl_query.cpp: checks the settings and queries of GlRadar.
#include "radar/batch/gl_query.hpp"

#include <cmath>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void require_valid(const GlRadarConfig& config) {
  const ConfigCheck require{"radar"};
  require(config.resolution_px >= 1 && config.resolution_px <= 4096, "resolution_px", config.resolution_px,
          "in 1..4096");
  require(config.overlap_tolerance_m >= 0.0 && std::isfinite(config.overlap_tolerance_m),
          "overlap_tolerance_m", config.overlap_tolerance_m, ">= 0");
  require(config.atlas_px >= 1 && config.atlas_px <= 16384, "atlas_px", config.atlas_px, "in 1..16384");
}

bool is_usable(const GlQuery& query) {
  constexpr double kMaxDistance_m = 1e4;
  const double norm = query.direction_world.stableNorm();
  return query.direction_world.allFinite() && norm > 0.0 && query.distance_m > 0.0 &&
         query.distance_m <= kMaxDistance_m && query.object.mesh != nullptr &&
         query.object.mesh->triangle_count() > 0 && query.object.T_world_mesh.matrix().allFinite();
}

}  // namespace roomradar
