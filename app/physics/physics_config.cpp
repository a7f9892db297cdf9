// physics_config.cpp: checks the settings of the physics.
#include "app/physics/physics_config.hpp"

#include <cmath>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void require_valid(const PhysicsConfig& config) {
  const ConfigCheck require{"physics"};
  const auto require_positive = [&](const char* name, double value) {
    require(std::isfinite(value) && value > 0.0, name, value, "> 0");
  };
  const auto require_not_negative = [&](const char* name, double value) {
    require(std::isfinite(value) && value >= 0.0, name, value, ">= 0");
  };
  require(config.gravity_world_mps2.allFinite(), "gravity_world_mps2", config.gravity_world_mps2.norm(),
          "finite");
  require(config.restitution >= 0.0 && config.restitution <= 1.0, "restitution", config.restitution,
          "in 0..1");
  require_not_negative("bounce_mps", config.bounce_mps);
  require_not_negative("friction", config.friction);
  require_not_negative("rolling", config.rolling);
  require_positive("contact_margin_m", config.contact_margin_m);
  require_not_negative("patch_reach_m", config.patch_reach_m);
  require_not_negative("roughness_m", config.roughness_m);
  require_positive("max_step_s", config.max_step_s);
  require_positive("max_advance_s", config.max_advance_s);
  require(config.max_advance_s <= 1000.0 * config.max_step_s, "max_advance_s", config.max_advance_s,
          "at most 1000 max_step_s");
  require(config.max_contact_events >= 1 && config.max_contact_events <= 64, "max_contact_events",
          config.max_contact_events, "in 1..64");
  require_positive("sleep_drift_m", config.sleep_drift_m);
  require_positive("sleep_after_s", config.sleep_after_s);
  require_positive("wake_gap_m", config.wake_gap_m);
  require_positive("wake_moved_m", config.wake_moved_m);
  require_positive("wake_overlap_m", config.wake_overlap_m);
  require_not_negative("overlap_allowed_m", config.overlap_allowed_m);
  require_positive("max_depenetration_mps", config.max_depenetration_mps);
  require_positive("max_speed_mps", config.max_speed_mps);
  require_positive("max_angular_rad_s", config.max_angular_rad_s);
}

}  // namespace roomradar
