// patch_matching.hpp: where a camera may stand that sees known patches of surface.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/patches.hpp"
#include "mapping/localization/place_matching.hpp"

namespace roomradar {

/// All patches of all places, in the world, by size.
struct KnownPatches {
  struct OfSize {
    std::vector<std::uint64_t> first_bits;  ///< of each patch's descriptor, close together in memory
    std::vector<SurfacePatch> patches;
    std::unordered_multimap<std::uint64_t, std::uint32_t>
        by_cell;  ///< positions of patches by where they are
  };
  std::array<OfSize, kPatchSizes> by_size;
  [[nodiscard]] bool empty() const;
};
KnownPatches known_patches(const Places& places);

struct PoseCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int agreeing = 0;              ///< patches of the frame that lie where known ones do that look alike
  std::vector<PointPair> pairs;  ///< of these, as in PatchProof::alike
};

/// Poses that at least `min_agreeing` patches agree on, the best first, none twice. Each pair of patches that
/// look alike votes for the whole pose that it implies, roughly; among those that agree with a vote, triples
/// of points say exactly. Deterministic.
std::vector<PoseCandidate> propose_poses(std::span<const SurfacePatch> seen, const KnownPatches& known,
                                         std::size_t most, int min_agreeing);

/// What a frame's patches say of a pose: of those that would lie on known ones, how many look like one of
/// them.
struct PatchProof {
  int compared = 0;
  std::vector<PointPair> alike;  ///< the known one's point in the world, the seen one's in the camera
  [[nodiscard]] double alike_part() const {
    return compared > 0 ? static_cast<double>(alike.size()) / compared : 0.0;
  }
};
PatchProof prove_with_patches(std::span<const SurfacePatch> seen, const KnownPatches& known,
                              const Eigen::Isometry3d& T_world_camera);

}  // namespace roomradar
