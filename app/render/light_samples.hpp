// light_samples.hpp: samples surface points of the map with their colours in the camera image.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "app/render/room_light.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A surface point of the static room in a frame.
struct LightSample {
  Eigen::Vector3f p_world_m = Eigen::Vector3f::Zero();
  /// Unit normal of the map's surface, towards the camera.
  Eigen::Vector3f normal_world = Eigen::Vector3f::UnitZ();
  /// Natural logarithm of red, green and blue in linear light. A byte b counts as (b / 255)^2, as in
  /// ObjectDrawer.
  Eigen::Vector3f log_colour = Eigen::Vector3f::Zero();
  LightReach reach;  ///< not set by take_light_samples()
};

/// A colour image with its camera.
struct ColourView {
  const ColourImage& colour;
  const Intrinsics& camera;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// The map's surface as seen from the depth camera, and the depth measured there.
struct SurfaceView {
  const DepthImage& expected_m;  ///< depth of the map
  const Intrinsics& camera;      ///< camera of expected_m
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Measured depth in the same view. Its size is that of expected_m or a multiple.
  const DepthImage& measured_m;
  /// Non-zero: dynamic pixel of expected_m. Empty: none.
  const MaskImage& dynamic_mask;
};

/// Takes up to `wanted` points at the next pixels of a sequence that covers the depth image evenly. Leaves
/// out dynamic points, points where measured and expected depth disagree, and points whose neighbourhood is
/// not one smooth surface. Also leaves out points outside the colour image, and points with a saturated or
/// almost black colour. Tests at most four pixels per wanted point. Reuses the vector's memory. Returns no
/// samples without colour or depth, or if sizes do not match.
/// @param[in,out] position  index in the sequence; 0 at first. Source of the sequence: see spread_points()
void take_light_samples(const ColourView& colour, const SurfaceView& surface, int wanted,
                        std::uint64_t& position, std::vector<LightSample>& samples);

}  // namespace roomradar
