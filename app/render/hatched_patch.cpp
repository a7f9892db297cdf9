// hatched_patch.cpp: intersects pixel rays with the patch's plane.
#include "app/render/hatched_patch.hpp"

#include <cmath>

#include "radar/gl/projection.hpp"

namespace roomradar {
namespace {

constexpr double kPeriod_m = 0.02;  // a stripe and the gap beside it
constexpr double kBehind_m = 0.03;  // real surface in front of the patch by more than this hides it
constexpr double kOpacity = 0.7;
constexpr Rgb kStripe{255, 140, 40};

std::uint8_t blend(std::uint8_t below, std::uint8_t above) {
  return static_cast<std::uint8_t>(std::lround((1.0 - kOpacity) * below + kOpacity * above));
}

void hatch(const HatchedPatch& patch, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
           const DepthImage& real_depth_m, ColourImage& picture) {
  if (!(patch.radius_m > 0.0) || !patch.middle_world.allFinite()) return;
  const Eigen::Vector3d reach(patch.radius_m, patch.radius_m, 0.001);
  const Eigen::AlignedBox3d box(-reach, reach);
  constexpr double kNearestSeen_m = 0.05;
  const PixelRect rect =
      clamped(pixels_of(box, camera, T_world_camera.inverse() * Eigen::Translation3d(patch.middle_world),
                        kNearestSeen_m),
              picture.width, picture.height);
  const Eigen::Vector3d origin = T_world_camera.translation() - patch.middle_world;
  for (int y = rect.y; y < rect.y + rect.height; ++y)
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      const Eigen::Vector3d ray = T_world_camera.linear() * back_project(camera, x, y, 1.0);
      const double depth_m = -origin.z() / ray.z();  // along the optical axis
      if (!(depth_m > kNearestSeen_m) || !std::isfinite(depth_m)) continue;
      const float real_m = real_depth_m.at(x, y);
      if (real_m > 0.0F && depth_m > static_cast<double>(real_m) + kBehind_m) continue;
      const Eigen::Vector2d p = (origin + depth_m * ray).head<2>();
      const double phase = (p.x() + p.y()) / (kPeriod_m * std::sqrt(2.0));
      if (p.norm() > patch.radius_m || phase - std::floor(phase) > 0.5) continue;
      Rgb& pixel = picture.at(x, y);
      pixel = {blend(pixel.r, kStripe.r), blend(pixel.g, kStripe.g), blend(pixel.b, kStripe.b)};
    }
}

}  // namespace

void hatch(std::span<const HatchedPatch> patches, const Intrinsics& camera,
           const Eigen::Isometry3d& T_world_camera, const DepthImage& real_depth_m, ColourImage& picture) {
  for (const HatchedPatch& patch : patches) hatch(patch, camera, T_world_camera, real_depth_m, picture);
}

}  // namespace roomradar
