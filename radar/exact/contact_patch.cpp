// contact_patch.cpp: sorts each piece's corners, weighs pieces, finds the nearest point.
#include "radar/exact/contact_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roomradar {
namespace {

Eigen::Vector3d mean_of(const PatchPiece& piece) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < piece.count; ++i) sum += piece.corners[i];
  return sum / static_cast<double>(piece.count);
}

/// Sorts the corners of a convex outline counter-clockwise, across the motion.
void sort_around(PatchPiece& piece) {
  const Eigen::Vector3d mean = mean_of(piece);
  std::sort(piece.corners.begin(), piece.corners.begin() + static_cast<std::ptrdiff_t>(piece.count),
            [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
              return std::atan2(a.y() - mean.y(), a.x() - mean.x()) <
                     std::atan2(b.y() - mean.y(), b.x() - mean.x());
            });
}

double cross2(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the point of the piece nearest to p across the motion.
Eigen::Vector3d nearest_in(const PatchPiece& piece, const Eigen::Vector2d& p) {
  const auto at = [&](std::size_t i) -> const Eigen::Vector3d& { return piece.corners[i % piece.count]; };
  // Test the triangles of the fan around the first corner.
  for (std::size_t i = 1; i + 1 < piece.count; ++i) {
    const Eigen::Vector3d a = at(i) - at(0), b = at(i + 1) - at(0);
    const Eigen::Vector3d q(p.x() - at(0).x(), p.y() - at(0).y(), 0.0);
    const double area = cross2(a, b);
    if (!(area > 0.0)) continue;
    const double u = cross2(q, b) / area, v = cross2(a, q) / area;
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) return at(0) + u * a + v * b;
  }
  Eigen::Vector3d best = at(0);
  double best_m2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Eigen::Vector3d edge = at(i + 1) - at(i);
    const double length2 = edge.head<2>().squaredNorm();
    const double along =
        length2 > 0.0 ? std::clamp((p - at(i).head<2>()).dot(edge.head<2>()) / length2, 0.0, 1.0) : 0.0;
    const Eigen::Vector3d q = at(i) + along * edge;
    const double m2 = (q.head<2>() - p).squaredNorm();
    if (m2 < best_m2) best_m2 = m2, best = q;
  }
  return best;
}

}  // namespace

void ContactPatch::Sums::add(PatchPiece& piece) {
  sort_around(piece);
  const Eigen::Vector3d mean = mean_of(piece);
  double longest = 0.0;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Eigen::Vector3d a = piece.corners[i], b = piece.corners[(i + 1) % piece.count];
    const double area = 0.5 * cross2(a - mean, b - mean);
    areas.add((a + b + mean).head<2>() / 3.0, std::max(area, 0.0));
    longest = std::max(longest, (b - a).head<2>().norm());
  }
  lengths.add(mean.head<2>(), longest);
  points.add(mean.head<2>(), 1.0);
}

void ContactPatch::clear() {
  pieces_.clear();
  forget_sums();
}

void ContactPatch::forget_sums() {
  sums_ = {};
  summed_count_ = 0;
}

void ContactPatch::leave_out_what_is_farther(double limit_m) {
  std::erase_if(pieces_, [&](const PatchPiece& p) { return p.contact_distance_m > limit_m; });
  if (summed_m_ > limit_m) forget_sums();
}

void ContactPatch::sum_up(double best_m) {
  for (PatchPiece& piece : pieces_) sums_.add(piece);
  summed_m_ = best_m;
  summed_count_ += pieces_.size();
  pieces_.clear();
}

void ContactPatch::add(const TriangleGap& gap, double contact_distance_m, double equally_m,
                       const FrameTriangle& scene, SurfaceKind kind, double best_m) {
  if (is_full()) leave_out_what_is_farther(best_m + equally_m);
  if (is_full() && !pieces_.empty()) return;
  if (pieces_.size() == kCapacity) {
    leave_out_what_is_farther(best_m + equally_m);
    if (pieces_.size() == kCapacity) sum_up(best_m);
  }
  PatchPiece& piece = pieces_.emplace_back();
  piece.contact_distance_m = contact_distance_m;
  piece.normal = scene.normal;
  piece.kind = kind;
  piece.count = 0;
  for (std::size_t i = 0; i < gap.count; ++i) {
    const TriangleGap::Vertex& p = gap.vertices[i];
    if (i != gap.lowest && p.gap > contact_distance_m + equally_m) continue;
    piece.corners[piece.count++] = {p.x, p.y, p.scene_z};
  }
}

Eigen::Vector2d ContactPatch::middle(double best_m, double equally_m) {
  leave_out_what_is_farther(best_m + equally_m);
  if (has_all() && pieces_.size() == 1 && pieces_[0].count == 1) return pieces_[0].corners[0].head<2>();
  Sums sums = sums_;
  for (PatchPiece& piece : pieces_) sums.add(piece);
  // Lines have no area and points no length, except for rounding.
  constexpr double kThin_m = 1e-9;
  const PlaceSum& sum = sums.areas.weight > kThin_m * sums.lengths.weight && sums.areas.weight > 0.0
                            ? sums.areas
                        : sums.lengths.weight > kThin_m ? sums.lengths
                                                        : sums.points;
  return sum.moment / sum.weight;
}

PatchPoint ContactPatch::nearest(const Eigen::Vector2d& place, double best_m, double equally_m) {
  leave_out_what_is_farther(best_m + equally_m);
  const PatchPiece* best = nullptr;
  Eigen::Vector3d best_point = Eigen::Vector3d::Zero();
  double best_m2 = std::numeric_limits<double>::infinity();
  for (PatchPiece& piece : pieces_) {
    sort_around(piece);
    const Eigen::Vector3d q = nearest_in(piece, place);
    const double m2 = (q.head<2>() - place).squaredNorm();
    // Among equally near pieces (a shared edge), choose the one that faces most against the motion.
    const bool is_nearer = best == nullptr || m2 < best_m2 - 1e-15;
    if (!is_nearer && !(m2 < best_m2 + 1e-15 && piece.normal.z() < best->normal.z())) continue;
    best = &piece;
    best_point = q;
    best_m2 = std::min(m2, best_m2);
  }
  return {best_point, best->normal, best->kind};
}

}  // namespace roomradar
