// contact_patch.hpp: the set of equally near contact points of one radar query, and the point nearest to
// their centroid.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Intersection of two triangles (object and scene) projected along the motion, restricted to the equally
/// near points: those whose gap exceeds the pair's distance to contact by at most a tolerance. In the frame
/// of the motion, z is the direction of motion.
struct PatchPiece {
  double contact_distance_m = 0.0;
  // Vertices of the intersection: points on the scene's triangle in the frame of the motion, m. Only the
  // first `count` are set.
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

/// Collects the equally near pieces while the search for the least distance continues. Stores up to kCapacity
/// pieces. A full store is replaced by its sums, so the centroid still includes the pieces.
class ContactPatch {
 public:
  static constexpr std::size_t kCapacity = 512;
  /// Max number of equally near pieces; later ones are dropped. Limits the exact tests to a few milliseconds.
  static constexpr std::size_t kMaxPieces = 4096;
  void clear();
  /// Returns true if kMaxPieces pieces have been collected. add() then discards pieces that are too far, and
  /// accepts a piece only if there is room or none is stored.
  [[nodiscard]] bool is_full() const { return summed_count_ + pieces_.size() >= kMaxPieces; }
  /// Adds the intersection of one pair of triangles.
  /// @param gap  vertices of the intersection, with the gap at each
  /// @param contact_distance_m  distance to contact of this pair
  /// @param equally_m  points at most this much farther than contact_distance_m count as equally near
  /// @param best_m  least distance to contact found so far
  void add(const TriangleGap& gap, double contact_distance_m, double equally_m, const FrameTriangle& scene,
           SurfaceKind kind, double best_m);
  /// Returns x and y of the centroid of the pieces that are at most equally_m farther than best_m. Pieces are
  /// weighted by area. If none has area, they are weighted by length. If none has length, weights are equal.
  /// Requires at least one piece.
  [[nodiscard]] Eigen::Vector2d middle(double best_m, double equally_m);
  /// Among the stored pieces at most equally_m farther than best_m, returns the point whose x and y are
  /// nearest to `place`. Requires at least one such piece.
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
  // Sums over the pieces that were removed from pieces_ when it was full.
  Sums sums_;
  // Least distance to contact found when the last pieces were added to sums_, m.
  double summed_m_ = 0.0;
  /// Number of pieces in the sums.
  std::size_t summed_count_ = 0;

  /// Removes the stored pieces farther than limit_m, and the sums if summed_m_ > limit_m.
  void leave_out_what_is_farther(double limit_m);
  /// Moves all stored pieces into the sums.
  void sum_up(double best_m);
};

}  // namespace roomradar
