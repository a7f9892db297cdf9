// kinect_depth.cpp: simulates shadow, noise, dropouts and quantisation of a structured-light depth camera.
#include "app/sim/sensor/kinect_depth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr double kKinectWidth_px = 640.0;
constexpr double kSubpixels = 8.0;  // disparity steps per pixel

/// Returns baseline times focal length of the full-size image, in px m: disparity = this / depth.
double disparity_scale(const Intrinsics& camera) {
  return camera.fx_px * kKinectWidth_px / camera.width_px * kKinectBaseline_m;
}

/// Noise correlated over about one lattice cell, as the Kinect's correlation window produces: independent
/// Gaussians on a lattice, interpolated, and scaled back to variance 1.
struct PatchNoise {
  static constexpr int kCell_px = 3;
  int columns = 0;
  const std::vector<float>* lattice = nullptr;

  [[nodiscard]] float at(int x, int y) const {
    // Offset by half a pixel, so that no pixel coincides with a lattice point and all weights are of similar
    // size.
    const float gx = (static_cast<float>(x) + 0.5F) / kCell_px;
    const float gy = (static_cast<float>(y) + 0.5F) / kCell_px;
    const int cx = static_cast<int>(gx);
    const int cy = static_cast<int>(gy);
    const float ax = gx - static_cast<float>(cx);
    const float ay = gy - static_cast<float>(cy);
    const float* at_00 =
        lattice->data() + static_cast<std::size_t>(cy) * static_cast<std::size_t>(columns) + cx;
    const float* at_01 = at_00 + columns;
    const float sum =
        (1 - ay) * ((1 - ax) * at_00[0] + ax * at_00[1]) + ay * ((1 - ax) * at_01[0] + ax * at_01[1]);
    const float variance = ((1 - ax) * (1 - ax) + ax * ax) * ((1 - ay) * (1 - ay) + ay * ay);
    return sum / std::sqrt(variance);
  }
};

PatchNoise make_patch_noise(const Intrinsics& camera, std::uint64_t key, KinectScratch& scratch) {
  PatchNoise noise;
  noise.columns = camera.width_px / PatchNoise::kCell_px + 2;
  noise.lattice = &scratch.lattice;
  const int rows = camera.height_px / PatchNoise::kCell_px + 2;
  const std::size_t size = static_cast<std::size_t>(noise.columns) * static_cast<std::size_t>(rows);
  if (scratch.lattice_key == key && scratch.lattice.size() == size) return noise;
  scratch.lattice_key = key;
  scratch.lattice.resize(size);
  for (std::size_t i = 0; i < size; ++i) scratch.lattice[i] = gaussian(mixed(key + i));
  return noise;
}

/// Rounds a depth to the nearest disparity that the Kinect can represent.
double quantised_depth_m(const Intrinsics& camera, double depth_m) {
  const double scale = kSubpixels * disparity_scale(camera);
  return scale / std::max(std::round(scale / depth_m), 1.0);
}

}  // namespace

PlanePoint<double> ray_of(const PixelRays& rays, int x, int y) {
  if (rays.empty()) return {static_cast<double>(x), static_cast<double>(y)};
  return {rays.at(x, y).x, rays.at(x, y).y};
}

double reported_m(const DepthFaults& faults, int x, int y, double depth_m) {
  if (faults.inverse_offset_per_m.empty()) return depth_m;
  return faults.inverse_scale / (1.0 / depth_m - faults.inverse_offset_per_m.at(x, y));
}

std::vector<RowBand> row_bands(int height_px, double readout_s) {
  constexpr int kRows = 4;  // at 90 degrees/s and 30 ms, half a band's motion is 0.2 px
  if (readout_s == 0.0) return {{0, height_px, 0.0}};
  std::vector<RowBand> bands;
  for (int begin = 0; begin < height_px; begin += kRows) {
    const int end = std::min(begin + kRows, height_px);
    bands.push_back({begin, end, (0.5 * (begin + end) / height_px - 0.5) * readout_s});
  }
  return bands;
}

void clear(const Intrinsics& camera, ExactView& exact) {
  exact.depth_m.resize(camera.width_px, camera.height_px);
  exact.solid.resize(camera.width_px, camera.height_px, -1);
  exact.cosine.resize(camera.width_px, camera.height_px);
}

void render_exact(std::span<const Solid> solids, const ViewCaster& view, const Intrinsics& camera,
                  const PixelRays& rays, const RowBand& band, ExactView& exact) {
  for (int y = band.begin; y < band.end; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const PlanePoint<double> ray = ray_of(rays, x, y);
      const PixelHit hit = view.cast(ray.x, ray.y);
      exact.depth_m.at(x, y) = static_cast<float>(hit.depth_m);
      exact.solid.at(x, y) = hit.solid;
      if (hit.solid < 0) continue;
      const Vector3d p_solid = view.local_point(hit.solid, ray.x, ray.y, hit.depth_m);
      const Vector3d to_camera = view.local_point(hit.solid, ray.x, ray.y, 0.0) - p_solid;
      const Vector3d normal = normal_local(solids[static_cast<std::size_t>(hit.solid)], p_solid);
      exact.cosine.at(x, y) =
          static_cast<float>(std::clamp(normal.dot(to_camera) / to_camera.norm(), 0.0, 1.0));
    }
}

void render_exact(std::span<const Solid> solids, const ViewCaster& view, const Intrinsics& camera,
                  const PixelRays& rays, ExactView& exact) {
  clear(camera, exact);
  render_exact(solids, view, camera, rays, {0, camera.height_px, 0.0}, exact);
}

double quantisation_step_m(const Intrinsics& camera, double depth_m) {
  return depth_m * depth_m / (kSubpixels * disparity_scale(camera));
}

void measure_depth(const InfraredSolids& lit, const DepthCameraView& view, const DepthErrors& errors,
                   const RowBand& band, KinectScratch& scratch, DepthImage& depth_m) {
  // Min returned light, relative to a white surface at 1 m. White paper is measured beyond the range, black
  // plastic (0.05) to some 3 m, and a wall at 4 m up to 82 degrees from its normal.
  constexpr double kFaintest = 0.005;
  constexpr double kRaggedness = 0.25;
  // Keeps a surface from shadowing itself.
  constexpr double kShadowMargin_m = 0.003;

  const Intrinsics& camera = view.camera;
  const ExactView& exact = view.exact;
  const std::uint64_t key = hash_of(errors.seed, static_cast<std::uint64_t>(errors.frame_index), 0x6b696e65);
  const PatchNoise patch_noise = make_patch_noise(camera, mixed(key), scratch);
  const Eigen::Isometry3d T_world_projector =
      view.T_world_camera * Eigen::Translation3d(kKinectBaseline_m, 0, 0);
  scratch.projector.prepare(lit.solids, camera, T_world_projector);
  const double disparity_px_m = camera.fx_px * kKinectBaseline_m;

  for (int y = band.begin; y < band.end; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      int solid = exact.solid.at(x, y);
      if (solid < 0) continue;
      const double theta = std::min(std::acos(exact.cosine.at(x, y)), 1.4835F);

      const std::uint64_t pixel_key = mixed(key + exact.depth_m.index(x, y));
      const double sigma_px = errors.noise_scale * camera.width_px / kKinectWidth_px *
                              (0.8 + 0.035 * theta / (0.5 * std::numbers::pi - theta));
      const double aside_x = sigma_px * gaussian(mixed(pixel_key + 1));
      const double aside_y = sigma_px * gaussian(mixed(pixel_key + 2));
      const int nearest_x = std::clamp(static_cast<int>(std::lround(x + aside_x)), 0, camera.width_px - 1);
      const int nearest_y = std::clamp(static_cast<int>(std::lround(y + aside_y)), 0, camera.height_px - 1);
      const PlanePoint<double> ray = ray_of(errors.faults.rays, x, y);
      const double u = ray.x + aside_x;
      const double v = ray.y + aside_y;
      solid = exact.solid.at(nearest_x, nearest_y);
      if (solid < 0) continue;
      double z = view.caster.depth_of(solid, u, v);
      if (z <= 0.0) z = exact.depth_m.at(nearest_x, nearest_y);  // just beside the solid's outline

      const float cosine = exact.cosine.at(nearest_x, nearest_y);
      const double ragged = 1.0 + kRaggedness * gaussian(mixed(pixel_key + 3));
      if (lit.infrared[static_cast<std::size_t>(solid)] * cosine / (z * z) < kFaintest * ragged) continue;
      if (scratch.projector.is_blocked(u - disparity_px_m / z, v, z - kShadowMargin_m)) continue;

      z = reported_m(errors.faults, x, y, z);
      const double sigma_m =
          errors.noise_scale * depth_sigma_m(DepthNoise{}, static_cast<float>(z), std::acos(cosine));
      const double step_m = quantisation_step_m(camera, z);
      const double before_quantising_m = std::sqrt(std::max(sigma_m * sigma_m - step_m * step_m / 12.0, 0.0));
      const double noisy_m = z + before_quantising_m * patch_noise.at(x, y);
      if (noisy_m < kKinectNearest_m) continue;
      const double reported_m = quantised_depth_m(camera, noisy_m);
      if (reported_m < kKinectNearest_m || reported_m > kKinectFarthest_m) continue;
      depth_m.at(x, y) = static_cast<float>(reported_m);
    }
}

void measure_depth(const InfraredSolids& lit, const DepthCameraView& view, const DepthErrors& errors,
                   KinectScratch& scratch, DepthImage& depth_m) {
  depth_m.resize(view.camera.width_px, view.camera.height_px);
  measure_depth(lit, view, errors, {0, view.camera.height_px, 0.0}, scratch, depth_m);
}

}  // namespace roomradar
