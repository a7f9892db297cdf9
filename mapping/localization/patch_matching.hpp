// patch_matching.hpp: camera pose hypotheses from matched surface patches.
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

/// All patches of the keyframe database, in the world, grouped by size.
struct PatchIndex {
  struct OfSize {
    std::vector<std::uint64_t> first_bits;  ///< first 64 bits of each descriptor, contiguous in memory
    std::vector<SurfacePatch> patches;
    std::unordered_multimap<std::uint64_t, std::uint32_t> by_cell;  ///< indices in `patches`, by 5 cm cell
  };
  std::array<OfSize, kPatchSizes> by_size;
  [[nodiscard]] bool empty() const;
};
PatchIndex build_patch_index(const KeyframeDatabase& keyframe_database);

struct PoseCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int agreeing = 0;              ///< patches of the frame that coincide with known ones of similar appearance
  std::vector<PointPair> pairs;  ///< their points, as in PatchAgreement::alike
};

/// Returns distinct poses that at least `min_agreeing` patches agree on, best first. Each pair of similar
/// patches votes for the approximate pose that it implies. RANSAC over point triples of the agreeing pairs
/// then gives the exact pose. Deterministic.
std::vector<PoseCandidate> propose_poses(std::span<const SurfacePatch> seen, const PatchIndex& known,
                                         std::size_t most, int min_agreeing);

/// Agreement of a frame's patches with the known patches at a pose. `compared` counts patches that coincide
/// with known ones; `alike` lists those that also look similar.
struct PatchAgreement {
  int compared = 0;
  std::vector<PointPair> alike;  ///< a: known point in the world; b: frame's point in the camera
  [[nodiscard]] double alike_part() const {
    return compared > 0 ? static_cast<double>(alike.size()) / compared : 0.0;
  }
};
PatchAgreement match_patches_at(std::span<const SurfacePatch> seen, const PatchIndex& known,
                                const Eigen::Isometry3d& T_world_camera);

}  // namespace roomradar
