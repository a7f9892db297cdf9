// departure.cpp: detects objects below the map, and sets them back.
#include "app/objects/departure.hpp"

#include <utility>

#include "app/objects/virtual_object.hpp"

namespace roomradar {

std::optional<Departure> end_departure(VirtualObject& object, double lowest_known_m) {
  constexpr double kBelow_m = 0.5;  // the fall is visible, and a floor's noise is not a fall
  if (!object.in_room || object.carried_to_world) return std::nullopt;
  Body& body = object.body;
  if (body.asleep) object.T_world_rested = body.T_world_object;
  const double top_m = middle_world(object).z() + radius_m(object);
  if (!(top_m < lowest_known_m - kBelow_m)) return std::nullopt;
  Departure departure{body.name, body.T_world_object.translation(), object.T_world_rested.has_value()};
  ++object.departures;
  body.velocity_world_mps.setZero();
  body.angular_velocity_world_rad_s.setZero();
  if (departure.is_back) {
    body.T_world_object = *std::exchange(object.T_world_rested, std::nullopt);
    body.asleep = true;
  } else {
    object.in_room = false;
  }
  return departure;
}

}  // namespace roomradar
