// patch_matching.hpp: where a camera may stand that sees known patches of surface.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/patches.hpp"
#include "mapping/places.hpp"

namespace roomradar {

/// All patches of all places, in the world, by size.
struct KnownPatches {
  struct OfSize {
    std::vector<std::uint64_t> first_bits;  ///< of each patch's descriptor, close together in memory
    std::vector<SurfacePatch> patches;
  };
  std::array<OfSize, kPatchSizes> by_size;
  [[nodiscard]] bool empty() const;
};
KnownPatches known_patches(const Places& places);

struct PoseCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int agreeing = 0;  ///< patches of the frame that lie where known ones do that look alike
};

/// Poses that at least `min_agreeing` patches agree on, the best first, none twice. Each pair of patches that
/// look alike votes for the whole pose that it implies, roughly; among those that agree with a vote, triples
/// of points say exactly. Deterministic.
std::vector<PoseCandidate> propose_poses(std::span<const SurfacePatch> seen, const KnownPatches& known,
                                         std::size_t most, int min_agreeing);

}  // namespace roomradar
