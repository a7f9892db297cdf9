// contact_patch.hpp: set of equally near contact points, and the point nearest to their centroid.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Equally near part of the intersection of two projected triangles, as points of the scene's triangle before
/// the motion.
struct PatchPiece {
  double contact_distance_m = 0.0;
  std::array<Eigen::Vector3d, 18> corners;  // frame of the motion, m
  std::size_t count = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  SurfaceKind kind = SurfaceKind::kNothing;
};

struct PatchPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  SurfaceKind kind;
};

/// Sums of weights and first moments of points, across the motion.
struct PlaceSum {
  double weight = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  void add(const Eigen::Vector2d& p, double w) {
    weight += w;
    moment += w * p;
  }
};

/// Collects pieces while the search for the least distance continues. Stores up to kCapacity pieces; earlier
/// ones are kept as sums only, so the centroid covers all of them.
class ContactPatch {
 public:
  static constexpr std::size_t kCapacity = 512;
  /// Max number of equally near pieces; later ones are dropped. Limits the exact tests to some milliseconds.
  static constexpr std::size_t kMaxPieces = 4096;
  void clear();
  /// Returns true if no further piece is accepted: kMaxPieces pieces are equally near.
  [[nodiscard]] bool is_full() const { return summed_count_ + pieces_.size() >= kMaxPieces; }
  /// @param equally_m  points at most this much farther than the nearest count as equally near
  void add(const TriangleGap& gap, double contact_distance_m, double equally_m, const FrameTriangle& scene,
           SurfaceKind kind, double best_m);
  /// Returns the centroid of the pieces within equally_m of best_m: of their areas if any, else of their
  /// lengths, else of their points. Requires at least one piece.
  [[nodiscard]] Eigen::Vector2d middle(double best_m, double equally_m);
  /// Returns the point nearest to `place` on the stored pieces within equally_m of best_m. Requires at least
  /// one stored piece.
  [[nodiscard]] PatchPoint nearest(const Eigen::Vector2d& place, double best_m, double equally_m);
  /// Returns true if every piece is still stored.
  [[nodiscard]] bool has_all() const { return summed_count_ == 0; }
  /// Drops the sums to make room for more pieces; stored pieces stay.
  void forget_sums();

 private:
  struct Sums {
    PlaceSum areas, lengths, points;
    void add(PatchPiece& piece);
  };
  std::vector<PatchPiece> pieces_;
  Sums sums_;              // pieces that are no longer stored
  double summed_m_ = 0.0;  // least distance when they were summed
  std::size_t summed_count_ = 0;

  void leave_out_what_is_farther(double limit_m);
  void sum_up(double best_m);
};

}  // namespace roomradar
