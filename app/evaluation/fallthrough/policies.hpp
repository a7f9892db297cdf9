// policies.hpp: the surface policies that the fall-through test compares. The test drops and pushes objects
// onto surfaces that are hidden from the camera, and counts those that pass through.
#pragma once
#include <array>
#include <string_view>

#include "dynamic/surface/surface_policy.hpp"

namespace roomradar {

struct FallthroughPolicy {
  std::string_view name;  ///< name in tables and reports
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  bool unknown_solid = false;  ///< true: the frontier of unknown space can be touched too
};

/// Costs of the policies are relative to that of the first.
inline constexpr std::array kFallthroughPolicies{
    FallthroughPolicy{"holes", SurfacePolicy::kHoles}, FallthroughPolicy{"skirt", SurfacePolicy::kSkirt},
    FallthroughPolicy{"border", SurfacePolicy::kBorder}, FallthroughPolicy{"map", SurfacePolicy::kMap},
    FallthroughPolicy{"map+unknown", SurfacePolicy::kMap, /*unknown_solid=*/true}};
inline constexpr std::size_t kPolicyCount = kFallthroughPolicies.size();

}  // namespace roomradar
