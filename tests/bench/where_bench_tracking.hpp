// where_bench_tracking.hpp: accuracy of tracking in a saved map, and recovery after the camera is carried
// away.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "where_bench_rooms.hpp"

namespace roomradar {

/// Tracks a hand-held camera while a large ball swings in front of it and a person and a hand move about.
/// Measures position error in the map and after the best rigid alignment (ATE), frames lost, and the fraction
/// of the view that moves.
nlohmann::json follow_behind_ball(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                                  std::int64_t frames);

/// Tracks a stationary camera; measures the jitter of its pose.
nlohmann::json stand_still(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                           std::int64_t frames);

/// Moves the camera elsewhere every 15 frames, every other time after two black frames. Counts the frames
/// until the pose is correct again, and how many of those had a wrong pose.
nlohmann::json carry_away(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                          std::int64_t jumps);

}  // namespace roomradar
