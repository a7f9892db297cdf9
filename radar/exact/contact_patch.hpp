// contact_patch.hpp: all places that touch at once, and the one of them nearest to their middle.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// The part of a pair's common outline that is equally near: on the scene's triangle, before the motion.
struct PatchPiece {
  double travel_m = 0.0;
  std::array<Eigen::Vector3d, 18> corners;  // in the frame, m
  std::size_t count = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Touched kind = Touched::kNothing;
};

struct PatchPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  Touched kind;
};

/// Weights and first moments of places, across the motion.
struct PlaceSum {
  double weight = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  void add(const Eigen::Vector2d& p, double w) {
    weight += w;
    moment += w * p;
  }
};

/// Collects pieces while the least travel is still sought. Holds kCapacity of them; what was held before is
/// remembered by its sums only, so that the middle is that of all.
class ContactPatch {
 public:
  static constexpr std::size_t kCapacity = 512;
  /// What comes when that many are equally near is left out: some milliseconds of settling.
  static constexpr std::size_t kMostPieces = 4096;
  void clear();
  /// Whether kMostPieces were equally near when the last one came.
  [[nodiscard]] bool is_full() const { return summed_count_ + pieces_.size() >= kMostPieces; }
  /// @param equally_m  how much farther than the nearest is still as near
  void add(const TriangleGap& gap, double travel_m, double equally_m, const FrameTriangle& scene,
           Touched kind, double best_m);
  /// Of the pieces within equally_m of best_m: of their area if they have any, else of their length, else of
  /// their points. There must be a piece.
  [[nodiscard]] Eigen::Vector2d middle(double best_m, double equally_m);
  /// The point of the pieces at hand, within equally_m of best_m, that is nearest to a place. There must be a
  /// piece.
  [[nodiscard]] PatchPoint nearest(const Eigen::Vector2d& place, double best_m, double equally_m);
  /// Whether every piece is at hand.
  [[nodiscard]] bool has_all() const { return summed_count_ == 0; }
  /// Makes room for more: only what is at hand stays.
  void forget_sums();

 private:
  struct Sums {
    PlaceSum areas, lengths, points;
    void add(PatchPiece& piece);
  };
  std::vector<PatchPiece> pieces_;
  Sums sums_;              // of pieces that are not at hand any more
  double summed_m_ = 0.0;  // least travel when they were summed up
  std::size_t summed_count_ = 0;

  void leave_out_what_is_farther(double limit_m);
  void sum_up(double best_m);
};

}  // namespace roomradar
