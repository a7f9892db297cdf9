// kinect_depth.hpp: the depth that a Kinect v1 would report of a scene whose exact depth is known.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "app/sim/sensor/sensor_faults.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// The projector stands this far along the depth camera's +x.
inline constexpr double kKinectBaseline_m = 0.075;
inline constexpr double kKinectNearest_m = 0.5;
inline constexpr double kKinectFarthest_m = 8.0;

struct ExactView {
  DepthImage depth_m;   ///< of the first surface, whatever the sensor's range; 0 = nothing
  Image<int> solid;     ///< index of the solid seen; -1 = nothing
  Image<float> cosine;  ///< of the angle between the ray and the surface's normal, 0 to 1
};

/// Exact depth, solid and angle of every pixel's centre ray.
/// @param rays  where the pixels look, in image coordinates of `camera`; empty: where a pinhole's do
void render_exact(std::span<const Solid> solids, const ViewCaster& view, const Intrinsics& camera,
                  const PixelRays& rays, ExactView& exact);

/// Step between neighbouring depths that disparities in 1/8 px of the Kinect's 640 px wide image can tell, at
/// depth_m: z^2 / (8 f b). Source: Khoshelham and Elberink, Sensors 2012, equation (5).
double quantisation_step_m(const Intrinsics& camera, double depth_m);

/// A depth snapped to the nearest disparity that the Kinect can tell.
double quantised_depth_m(const Intrinsics& camera, double depth_m);

/// What is wrong with the depth camera; empty images: nothing.
struct DepthFaults {
  PixelRays rays;
  Image<float> inverse_offset_per_m;
  double inverse_scale = 1.0;
};

/// Where pixel (x, y) looks, in image coordinates.
PlanePoint<double> ray_of(const PixelRays& rays, int x, int y);

/// What a camera with these faults says of a depth > 0 at a pixel.
double reported_m(const DepthFaults& faults, int x, int y, double depth_m);

/// Scratch memory of measure_depth, and its view from the projector.
struct KinectScratch {
  ViewCaster projector;
  std::vector<float> lattice;
};

/// What the sensor reports for frame `frame_index`, by these steps:
///  - lateral noise: each pixel looks off its centre by sigma_L = 0.8 + 0.035 theta / (pi/2 - theta) px;
///  - shadow: 0 where a solid stands between the projector and the surface;
///  - dropouts: 0 where too little light comes back (dark, grazing, far), with a ragged limit;
///  - axial noise: sigma(z, theta) of depth_noise.hpp, less what quantisation adds, alike over some 3 pixels;
///  - quantisation of the disparity, and 0 outside of 0.5 to 8 m.
/// @param infrared     part of the light that each solid returns
/// @param exact        made with faults.rays
/// @param noise_scale  times both sigmas; > 0
/// @param depth_m      out: of the camera's size
/// Deterministic in (seed, frame_index); other frames do not matter.
/// Source: Nguyen, Izadi, Lovell, 3DIMPVT 2012, equations (1) and (3).
void measure_depth(std::span<const Solid> solids, std::span<const float> infrared, const ViewCaster& view,
                   const ExactView& exact, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   const DepthFaults& faults, double noise_scale, std::uint64_t seed,
                   std::int64_t frame_index, KinectScratch& scratch, DepthImage& depth_m);

}  // namespace roomradar
