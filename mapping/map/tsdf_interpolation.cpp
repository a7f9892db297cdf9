// tsdf_interpolation.cpp: trilinear interpolation of eight samples.
#include "mapping/map/tsdf_interpolation.hpp"

#include <array>

namespace roomradar {

std::optional<DistanceAt> distance_at(const StaticMap& map, const Eigen::Vector3d& p_world) {
  const double voxel_m = map.resolution_m();
  const Eigen::Vector3d p =
      p_world / voxel_m - Eigen::Vector3d::Constant(0.5);  // voxel centres at integer coordinates
  if (!p.allFinite()) return std::nullopt;
  const Eigen::Vector3d low = p.array().floor();
  const Eigen::Vector3d t = p - low;
  std::array<double, 8> d{};
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner = low + Eigen::Vector3d(i & 1U, (i >> 1U) & 1U, (i >> 2U) & 1U);
    const auto sample = map.sample_at((corner + Eigen::Vector3d::Constant(0.5)) * voxel_m);
    if (!sample) return std::nullopt;
    d[i] = static_cast<double>(sample->distance_m);
  }
  const auto mix = [](double a, double b, double share) { return a + share * (b - a); };
  const double x00 = mix(d[0], d[1], t.x()), x10 = mix(d[2], d[3], t.x());
  const double x01 = mix(d[4], d[5], t.x()), x11 = mix(d[6], d[7], t.x());
  const double y0 = mix(x00, x10, t.y()), y1 = mix(x01, x11, t.y());
  DistanceAt at;
  at.distance_m = mix(y0, y1, t.z());
  at.gradient.x() = mix(mix(d[1] - d[0], d[3] - d[2], t.y()), mix(d[5] - d[4], d[7] - d[6], t.y()), t.z());
  at.gradient.y() = mix(x10 - x00, x11 - x01, t.z());
  at.gradient.z() = y1 - y0;
  at.gradient /= voxel_m;
  return at;
}

}  // namespace roomradar
