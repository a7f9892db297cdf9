// set_motion.hpp: moves bodies at the same time, those whose paths may meet as one set.
#pragma once
#include <span>
#include <vector>

#include "app/physics/contact_system.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Moves the active bodies at the same time, each until its first contact or for the rest of its substep
/// (MovingBody::left_s). Bodies that meet stop at the same time; the others move on, past those two at rest.
/// Bodies whose paths cannot meet are independent. Sets MovingBody::limited_by.
/// @param motions   one per body; only those of active bodies are used
/// @param margin_m  contact margin; approaching surfaces stop at half of it
/// @param worker    shares the queries, with the same results; may be null
/// @return per body the duration of its motion, s; 0 if it is not active
std::vector<double> move_active(std::span<MovingBody> bodies, const std::vector<RigidMotion>& motions,
                                double margin_m, WorkerThread* worker);

}  // namespace roomradar
