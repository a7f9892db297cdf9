// patches.hpp: pieces of textured surface that look alike from wherever they are seen.
#pragma once
#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// 256 comparisons of brightness.
using Descriptor = std::array<std::uint8_t, 32>;
/// How many of them differ. Unrelated descriptors differ in 128, and rarely in less than 80.
inline int distance_bits(const Descriptor& a, const Descriptor& b) {
  using Words = std::array<std::uint64_t, 4>;
  const auto p = std::bit_cast<Words>(a), q = std::bit_cast<Words>(b);
  return std::popcount(p[0] ^ q[0]) + std::popcount(p[1] ^ q[1]) + std::popcount(p[2] ^ q[2]) +
         std::popcount(p[3] ^ q[3]);
}

/// A square piece of surface as if looked at straight on: where it is, how it lies, and what it looks like.
/// Two views of one patch tell each its whole pose in the other.
struct SurfacePatch {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();    ///< m, its middle
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit, towards the viewer
  Eigen::Vector3f along = Eigen::Vector3f::UnitX();   ///< unit, in the surface, towards its brighter side
  std::uint8_t size = 0;                              ///< patch_width_m(size) to a side
  Descriptor bits{};
};

inline constexpr int kPatchSizes = 4;
/// Patches are of these widths only, so that a view from twice as far still finds the same ones.
inline float patch_width_m(int size) { return 0.06F * static_cast<float>(1 << size); }

/// The most cornered patches of a frame, at most so many, in its depth camera. None where the frame has no
/// colour or no flat surface. Deterministic.
/// Source: Wu, Clipp, Li, Frahm, Pollefeys, 3D model matching with viewpoint-invariant patches, CVPR 2008;
/// Calonder, Lepetit, Strecha, Fua, BRIEF, ECCV 2010.
std::vector<SurfacePatch> describe_patches(const Frame& frame, int most);

}  // namespace roomradar
