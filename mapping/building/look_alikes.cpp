// look_alikes.cpp: the motion between the places that a refused join takes for one.
#include "mapping/building/look_alikes.hpp"

#include "mapping/localization/pose_hypothesis.hpp"

namespace roomradar {

std::vector<LookAlike> find_look_alikes(std::span<const PlacedSubmap> submaps, std::size_t part,
                                        std::span<const GraphJoin> refused) {
  constexpr std::size_t kMostPerJoin = 12;
  constexpr double kSamePlace_m = 0.5, kSamePlace_rad = 0.5;
  std::vector<LookAlike> look_alikes;
  for (const GraphJoin& one : refused) {
    const PlacedSubmap &a = submaps[one.a], &b = submaps[one.b];
    if (a.part != part || b.part != part) continue;
    for (const KeyframeLink& link : spread_evenly(one.join.links, kMostPerJoin)) {
      const Eigen::Isometry3d &T_world_a = a.T_building_keyframe[link.a],
                              &T_world_b = b.T_building_keyframe[link.b];
      const Eigen::Isometry3d T_b_a = T_world_b * link.T_a_b.inverse() * T_world_a.inverse();
      if (is_near(T_b_a * T_world_a, T_world_a, kSamePlace_m, kSamePlace_rad)) continue;
      look_alikes.push_back({T_world_a.translation(), T_b_a});
      look_alikes.push_back({T_world_b.translation(), T_b_a.inverse()});
    }
  }
  return look_alikes;
}

}  // namespace roomradar
