// patches.hpp: viewpoint-invariant descriptors of textured surface patches.
#pragma once
#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "mapping/types/frame.hpp"

namespace roomradar {

/// 256 brightness comparisons, one bit each.
using Descriptor = std::array<std::uint8_t, 32>;
/// Returns the number of bits that differ. Unrelated descriptors differ in 128 on average, and rarely in
/// fewer than 80.
inline int distance_bits(const Descriptor& a, const Descriptor& b) {
  using Words = std::array<std::uint64_t, 4>;
  const auto p = std::bit_cast<Words>(a), q = std::bit_cast<Words>(b);
  return std::popcount(p[0] ^ q[0]) + std::popcount(p[1] ^ q[1]) + std::popcount(p[2] ^ q[2]) +
         std::popcount(p[3] ^ q[3]);
}

/// Square surface patch as if viewed frontally: position, orientation and appearance. One patch matched in
/// two views gives their full relative pose.
struct SurfacePatch {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();    ///< m, centre
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit, towards the viewer
  Eigen::Vector3f along = Eigen::Vector3f::UnitX();   ///< unit, in the surface, towards its brighter side
  std::uint8_t size = 0;                              ///< edge length is patch_width_m(size)
  Descriptor bits{};
};

inline constexpr int kPatchSizes = 4;
/// Returns the edge length of a patch. Lengths are discrete, so a view from twice the distance finds the same
/// patches.
inline float patch_width_m(int size) { return 0.06F * static_cast<float>(1 << size); }

/// Returns at most `most` patches at a frame's strongest corners, in its depth camera. Empty if the frame has
/// no colour or no flat surface. Deterministic. Source: Wu, Clipp, Li, Frahm, Pollefeys, 3D model matching
/// with viewpoint-invariant patches, CVPR 2008; Calonder, Lepetit, Strecha, Fua, BRIEF, ECCV 2010.
std::vector<SurfacePatch> describe_patches(const Frame& frame, int most);

}  // namespace roomradar
