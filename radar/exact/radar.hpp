// radar.hpp: the question that each kind of Cyber Radar answers.
#pragma once
#include "radar/exact/radar_query.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Distance to contact of an object that moves along a line. Implemented by CyberRadar (exact or sampled, on
/// the processor) and PassesRadar (two rendered depth passes).
class Radar {
 public:
  virtual ~Radar() = default;
  /// Computes the first contact. Never throws.
  virtual Contact query(const RadarQuery& query, const RadarScene& scene) = 0;

 protected:
  Radar() = default;
  Radar(const Radar&) = default;
  Radar(Radar&&) = default;
  Radar& operator=(const Radar&) = default;
  Radar& operator=(Radar&&) = default;
};

}  // namespace roomradar
