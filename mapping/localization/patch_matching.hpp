// patch_matching.hpp: finds camera pose hypotheses by matching surface patches.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/patches.hpp"
#include "mapping/localization/place_matching.hpp"

namespace roomradar {

/// Patches of a keyframe database, in the world frame, grouped by patch size. A patch that several keyframes
/// show alike is stored once.
struct PatchIndex {
  struct OfSize {
    /// First 64 bits of each patch's descriptor, contiguous in memory for fast comparison.
    std::vector<std::uint64_t> first_bits;
    std::vector<SurfacePatch> patches;
    /// Per hash of a 5 cm cell, the number (index in `patches` + 1) of the last patch whose centre is in one
    /// of these cells; 0: none. The size is a power of two, or 0.
    std::vector<std::uint32_t> last_of_hash;
    /// Per patch, the number of the previous patch with the same hash; 0: none.
    std::vector<std::uint32_t> before;
  };
  std::array<OfSize, kPatchSizes> by_size;
  [[nodiscard]] bool empty() const;
};
PatchIndex build_patch_index(const KeyframeDatabase& keyframe_database);

struct PoseCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Number of the frame's patches that at this pose coincide with known patches of similar appearance.
  int agreeing = 0;
  /// Pairs of centres of the coinciding patches; see PatchAgreement::alike.
  std::vector<PointPair> pairs;
};

/// Returns at most `most` distinct poses that at least `min_agreeing` patches of the frame support, best
/// first. Each of the 400 most similar pairs of patches (one of the frame, one known) votes for the
/// approximate pose that it implies. RANSAC over triples of patch centres then refines each pose from its
/// supporting pairs. Deterministic.
std::vector<PoseCandidate> propose_poses(std::span<const SurfacePatch> seen, const PatchIndex& known,
                                         std::size_t most, int min_agreeing);

/// Comparison of a frame's patches with the known patches at a pose. `compared` is the number of the frame's
/// patches that coincide with known patches, regardless of appearance. `alike` lists the coinciding pairs
/// that also look similar.
struct PatchAgreement {
  int compared = 0;
  /// Pairs of patch centres: a in the world (known patch), b in the camera frame (frame's patch).
  std::vector<PointPair> alike;
  [[nodiscard]] double alike_part() const {
    return compared > 0 ? static_cast<double>(alike.size()) / compared : 0.0;
  }
};
PatchAgreement match_patches_at(std::span<const SurfacePatch> seen, const PatchIndex& known,
                                const Eigen::Isometry3d& T_world_camera);

}  // namespace roomradar
