// dynamic_surface_config.cpp: checks the settings of the dynamic surface.
#include "dynamic/surface/dynamic_surface_config.hpp"

#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void require_valid(const DynamicSurfaceConfig& config) {
  const ConfigCheck require{"dynamic_surface"};
  const auto require_sigmas = [&require](const char* field, float value) {
    require(value > 0.0F && value < 1e3F, field, value, "over 0 and under 1000");
  };
  require_sigmas("deviation_sigmas", config.deviation_sigmas);
  require_sigmas("flat_sigmas", config.flat_sigmas);
  require_sigmas("cut_sigmas", config.cut_sigmas);
  require_sigmas("jump_sigmas", config.jump_sigmas);
  require(config.jump_incidence_deg >= 0.0F && config.jump_incidence_deg < 90.0F, "jump_incidence_deg",
          config.jump_incidence_deg, "at least 0 and under 90");
  require(config.least_thickness_m > 0.0F && config.least_thickness_m < 10.0F, "least_thickness_m",
          config.least_thickness_m, "over 0 and under 10");
  require(config.most_thickness_m >= config.least_thickness_m && config.most_thickness_m < 10.0F,
          "most_thickness_m", config.most_thickness_m, "at least least_thickness_m and under 10");
  require(config.least_roundness >= 0.0F && config.least_roundness <= 1.0F, "least_roundness",
          config.least_roundness, "in 0..1");
  require(config.back_clearance_m >= 0.0F && config.back_clearance_m < 1.0F, "back_clearance_m",
          config.back_clearance_m, "at least 0 and under 1");
}

}  // namespace roomradar
