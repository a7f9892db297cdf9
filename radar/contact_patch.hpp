// contact_patch.hpp: all places that touch at once, and the one of them nearest to their middle.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "radar/contact.hpp"
#include "radar/triangle_gap.hpp"

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

/// Collects pieces while the least travel is still sought. Room for kCapacity pieces; what comes when that
/// many are equally near is left out.
class ContactPatch {
 public:
  static constexpr std::size_t kCapacity = 512;
  void clear() { pieces_.clear(); }
  /// Whether it holds kCapacity pieces that were equally near when the last one came.
  [[nodiscard]] bool is_full() const { return pieces_.size() >= kCapacity; }
  /// @param equally_m  how much farther than the nearest is still as near
  void add(const TriangleGap& gap, double travel_m, double equally_m, const FrameTriangle& scene,
           Touched kind, double best_m);
  /// The point of the pieces within equally_m of best_m that is nearest to their middle: of their area if
  /// they have any, else of their length, else of their points. There must be a piece.
  [[nodiscard]] PatchPoint middle(double best_m, double equally_m);

 private:
  std::vector<PatchPiece> pieces_;
};

}  // namespace roomradar
