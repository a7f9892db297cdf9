// overlap_depth.hpp: distance back along the motion until an object is clear of what it overlaps.
#pragma once
#include <vector>

#include "radar/exact/scene_in_frame.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/solid_inside.hpp"

namespace roomradar {

/// Scratch memory kept between queries.
struct OverlapScratch {
  struct Span {
    double low_m, high_m;
    Eigen::Vector3d point;
  };
  std::vector<Span> spans;
  std::vector<Layer> layers;
  ColumnScratch columns;
  std::vector<SceneItem> items;
};

/// A scene triangle in the frame, and its kind.
struct OverlappedTriangle {
  FrameTriangle triangle;
  SurfaceKind kind = SurfaceKind::kNothing;
};

struct Overlap {
  double depth_m = 0.0;  ///< > 0; 0: no overlap
  bool is_all = true;    ///< false: depth_m is a lower bound, as the search was cut short
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< in the frame, where they separate last
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the scene's triangle, by its winding
  SurfaceKind kind = SurfaceKind::kNothing;
};

/// Work after which the search is cut short: a few milliseconds. An object that is sunk in the ground and
/// moves along it would be clear only where the ground ends.
inline constexpr std::uint64_t kMostOverlapWork = 40'000;

/// Computes how deep the object overlaps the scene. A pair of triangles crosses over an interval of travel,
/// from its least gap to its greatest. Between these intervals, a scene triangle is inside a closed object if
/// more exits from the solid than entries are ahead of it. The depth is how far back the union of the
/// intervals that contains 0 reaches. Back-facing scene triangles are ignored.
/// @param known  an overlapped triangle, reported if the search is cut short before it finds one
Overlap overlap_depth(const TurnedTree& object, const ObjectHeightMap& front, SceneInFrame& scene,
                      const OverlappedTriangle& known, OverlapScratch& scratch);

}  // namespace roomradar
