// contact_patch.hpp: the set of equally near contact points of one radar query, and the point nearest to
// their centroid.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Intersection of two projected triangles (object and scene), restricted to the points that are equally
/// near: at most a tolerance farther than the nearest point of the query. The frame of the motion has the
/// direction of motion as its z axis.
struct PatchPiece {
  double contact_distance_m = 0.0;
  // Points on the scene's triangle before the motion, in the frame of the motion, m. Only the first `count`
  // are set.
  std::array<Eigen::Vector3d, 18> corners;
  std::size_t count = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  SurfaceKind kind = SurfaceKind::kNothing;
};

struct PatchPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  SurfaceKind kind;
};

/// Sum of weights, and weighted sum of positions in the plane perpendicular to the motion, m.
struct PlaceSum {
  double weight = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  void add(const Eigen::Vector2d& p, double w) {
    weight += w;
    moment += w * p;
  }
};

/// Collects pieces while the search for the least distance continues. Stores up to kCapacity pieces. Earlier
/// pieces are kept as sums only, so the centroid still includes them.
class ContactPatch {
 public:
  static constexpr std::size_t kCapacity = 512;
  /// Max number of equally near pieces; later pieces are dropped. Limits the exact tests to a few
  /// milliseconds.
  static constexpr std::size_t kMaxPieces = 4096;
  void clear();
  /// Returns true if kMaxPieces pieces have been collected, so no further piece is accepted.
  [[nodiscard]] bool is_full() const { return summed_count_ + pieces_.size() >= kMaxPieces; }
  /// Adds the intersection of one pair of triangles.
  /// @param gap  vertices of the intersection, with the gap at each
  /// @param contact_distance_m  distance to contact of this pair
  /// @param equally_m  points at most this much farther than the nearest point count as equally near
  /// @param scene  the scene's triangle
  /// @param best_m  least distance to contact found so far
  void add(const TriangleGap& gap, double contact_distance_m, double equally_m, const FrameTriangle& scene,
           SurfaceKind kind, double best_m);
  /// Returns the x and y of the centroid of the pieces at most equally_m farther than best_m. Pieces are
  /// weighted by area; if none has area, by length; if none has length, all are weighted equally. Requires at
  /// least one piece.
  [[nodiscard]] Eigen::Vector2d middle(double best_m, double equally_m);
  /// Returns the point nearest to `place` (perpendicular to the motion) on the stored pieces that are at most
  /// equally_m farther than best_m. Requires at least one stored piece.
  [[nodiscard]] PatchPoint nearest(const Eigen::Vector2d& place, double best_m, double equally_m);
  /// Returns true if every collected piece is still stored.
  [[nodiscard]] bool has_all() const { return summed_count_ == 0; }
  /// Discards the sums to make room for more pieces; stored pieces are kept.
  void forget_sums();

 private:
  struct Sums {
    PlaceSum areas, lengths, points;
    void add(PatchPiece& piece);
  };
  std::vector<PatchPiece> pieces_;
  // Sums over the pieces that are no longer stored.
  Sums sums_;
  // Least distance to contact when those pieces were added to the sums, m.
  double summed_m_ = 0.0;
  /// Number of pieces in the sums.
  std::size_t summed_count_ = 0;

  /// Removes stored pieces farther than limit_m, and the sums if they are farther.
  void leave_out_what_is_farther(double limit_m);
  /// Moves all stored pieces into the sums.
  void sum_up(double best_m);
};

}  // namespace roomradar
