// triangle_distance.hpp: point-to-segment and point-to-triangle distance.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>

namespace roomradar {

/// Returns the squared distance from p to the segment from a to a + ab, in the inputs' units squared.
inline float squared_distance_to_segment(const Eigen::Vector3f& p, const Eigen::Vector3f& a,
                                         const Eigen::Vector3f& ab) {
  const float along = ab.dot(p - a) / std::max(ab.squaredNorm(), 1e-30F);
  return (p - a - std::clamp(along, 0.0F, 1.0F) * ab).squaredNorm();
}

/// Returns the squared distance from p to the triangle a, b, c, in the inputs' units squared. Also correct
/// for degenerate triangles. Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
inline float squared_distance_to_triangle(const Eigen::Vector3f& p, const Eigen::Vector3f& a,
                                          const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3f ab = b - a;
  const Eigen::Vector3f ac = c - a;
  const Eigen::Vector3f normal = ab.cross(ac);
  // Triangles this thin (height / length) are treated as segments: rounding errors make region tests
  // meaningless.
  constexpr float kThin = 1e-4F;
  const float longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
  if (normal.squaredNorm() <= kThin * kThin * longest2 * longest2)
    return std::min({squared_distance_to_segment(p, a, ab), squared_distance_to_segment(p, b, c - b),
                     squared_distance_to_segment(p, a, ac)});
  const Eigen::Vector3f ap = p - a;
  const float d1 = ab.dot(ap);
  const float d2 = ac.dot(ap);
  if (d1 <= 0.0F && d2 <= 0.0F) return ap.squaredNorm();
  const Eigen::Vector3f bp = p - b;
  const float d3 = ab.dot(bp);
  const float d4 = ac.dot(bp);
  if (d3 >= 0.0F && d4 <= d3) return bp.squaredNorm();
  const Eigen::Vector3f cp = p - c;
  const float d5 = ab.dot(cp);
  const float d6 = ac.dot(cp);
  if (d6 >= 0.0F && d5 <= d6) return cp.squaredNorm();
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0F && d1 >= 0.0F && d3 <= 0.0F) return (ap - d1 / std::max(d1 - d3, 1e-30F) * ab).squaredNorm();
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0F && d2 >= 0.0F && d6 <= 0.0F) return (ap - d2 / std::max(d2 - d6, 1e-30F) * ac).squaredNorm();
  const float va = d3 * d6 - d5 * d4;
  const float along_b = d4 - d3;
  const float along_c = d5 - d6;
  if (va <= 0.0F && along_b >= 0.0F && along_c >= 0.0F)
    return (bp - along_b / std::max(along_b + along_c, 1e-30F) * (c - b)).squaredNorm();
  const float along_normal = normal.dot(ap);
  return along_normal * along_normal / normal.squaredNorm();
}

}  // namespace roomradar
