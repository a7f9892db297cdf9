// set_motion.hpp: moves bodies simultaneously; bodies whose paths may intersect form one set (island).
#pragma once
#include <span>
#include <vector>

#include "app/physics/contact_system.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Moves the active bodies simultaneously, each until its first contact or for the rest of its substep
/// (MovingBody::left_s). Bodies that touch each other stop at the time of impact. The other bodies continue,
/// with the stopped bodies as obstacles at rest. Bodies whose paths cannot intersect are independent. A
/// body's motion also ends when a query extends its contact-free time by less than 2 % of left_s, or after 13
/// queries; see move_to_contact(). Sets MovingBody::limited_by.
/// @param motions   one per body; only those of active bodies are used
/// @param margin_m  contact margin; approaching surfaces stop at half of it
/// @param worker    runs some of the queries on a second thread; results are the same without it; may be null
/// @return duration of each body's motion, s; 0 for an inactive body
std::vector<double> move_active(std::span<MovingBody> bodies, const std::vector<RigidMotion>& motions,
                                double margin_m, WorkerThread* worker);

}  // namespace roomradar
