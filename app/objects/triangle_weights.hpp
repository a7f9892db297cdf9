// triangle_weights.hpp: barycentric coordinates.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>

namespace roomradar {

/// Returns the barycentric coordinates of the point of triangle a, b, c that is nearest to p. They are
/// approximate if p projects outside the triangle.
inline Eigen::Vector3f triangle_weights(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                                        const Eigen::Vector3f& c, const Eigen::Vector3f& p) {
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  const auto part = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    return std::max(0.0F, (to - from).cross(p - from).dot(normal));
  };
  const Eigen::Vector3f weights(part(b, c), part(c, a), part(a, b));
  const float sum = weights.sum();
  return sum > 0.0F ? Eigen::Vector3f(weights / sum) : Eigen::Vector3f::Constant(1.0F / 3.0F);
}

}  // namespace roomradar
