// where_bench_tracking.hpp: how well a camera is followed in a saved map, and mended when it is carried away.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "where_bench_rooms.hpp"

namespace roomradar {

/// A camera in a hand while a large ball swings before it, and a person and a hand move about: position error
/// in the map and after the best rigid alignment (ATE), frames lost, and the part of the view that moves.
nlohmann::json follow_behind_ball(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                                  std::int64_t frames);

/// A camera that stands still: how much its pose shakes.
nlohmann::json stand_still(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                           std::int64_t frames);

/// A camera that is somewhere else every 15 frames, after two black frames every other time: how many frames
/// pass until it is right again, and in how many of them a wrong pose was given.
nlohmann::json carry_away(const std::string& name, const SimOptions& scan, SearchedRoom& mapped,
                          std::int64_t jumps);

}  // namespace roomradar
