// patches.hpp: square patches of textured surfaces, with descriptors that do not depend on the viewpoint.
#pragma once
#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// Binary descriptor of 256 brightness comparisons, one bit per comparison.
using Descriptor = std::array<std::uint8_t, 32>;
/// Returns the Hamming distance. Descriptors of different patches have distance 128 on average, and rarely
/// less than 80.
inline int distance_bits(const Descriptor& a, const Descriptor& b) {
  using Words = std::array<std::uint64_t, 4>;
  const auto p = std::bit_cast<Words>(a), q = std::bit_cast<Words>(b);
  return std::popcount(p[0] ^ q[0]) + std::popcount(p[1] ^ q[1]) + std::popcount(p[2] ^ q[2]) +
         std::popcount(p[3] ^ q[3]);
}

/// Square surface patch: position, orientation and appearance in a frontal view. The image is rectified to
/// this view with depth. A single patch matched between two views gives their full relative pose.
struct SurfacePatch {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();    ///< centre, m
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit, towards the camera
  /// Unit vector in the patch's plane, from the centre towards the patch's brighter side.
  Eigen::Vector3f along = Eigen::Vector3f::UnitX();
  std::uint8_t size = 0;  ///< 0..kPatchSizes - 1; see patch_width_m()
  Descriptor bits{};
};

inline constexpr int kPatchSizes = 4;
/// Returns the edge length of patches of this size, m. Patches have four fixed edge lengths, measured on the
/// surface. Cameras at different distances thus extract the same patches.
inline float patch_width_m(int size) { return 0.06F * static_cast<float>(1 << size); }

/// Returns at most `most` patches at a frame's strong image corners, spread over the image, in the depth
/// camera's frame. Returns an empty vector if the frame has no colour or no flat surface. Deterministic.
/// Source: Wu, Clipp, Li, Frahm, Pollefeys, 3D model matching with viewpoint-invariant patches, CVPR 2008;
/// Calonder, Lepetit, Strecha, Fua, BRIEF, ECCV 2010.
std::vector<SurfacePatch> describe_patches(const Frame& frame, int most);

}  // namespace roomradar
