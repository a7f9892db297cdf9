// scenario_frame.hpp: the camera frames of a scenario while its object moves.
#pragma once
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Returns the occluder's solids at the time of frame `frame`.
std::vector<Solid> occluder_at(const Scenario& scenario, int frame);

/// Renders the camera's depth frame of the room and the occluder, without colour.
/// @param noise_scale  factor on the Kinect's noise, see SimOptions::noise_scale; 0: exact depth
void render_scenario(const Scenario& scenario, const Room& room, int frame_number, double noise_scale,
                     Frame& frame);

}  // namespace roomradar
