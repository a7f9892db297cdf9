// overlap_depth.hpp: how far back along the motion is an object free of what it overlaps?
#pragma once
#include <vector>

#include "radar/exact/scene_in_frame.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/solid_inside.hpp"

namespace roomradar {

/// Scratch that is kept from query to query.
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

/// A triangle of the scene in the frame, and what it is of.
struct OverlappedTriangle {
  FrameTriangle triangle;
  Touched kind = Touched::kNothing;
};

struct Overlap {
  double depth_m = 0.0;                              ///< > 0; 0: they do not overlap
  bool is_all = true;                                ///< false: at least so deep; the search was cut short
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< in the frame, where they part last
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the scene's triangle, by the winding
  Touched kind = Touched::kNothing;
};

/// Work after which the search is cut short: a few milliseconds. An object that is sunk in the ground and
/// moves along it would be free again only where the ground ends.
inline constexpr std::uint64_t kMostOverlapWork = 40'000;

/// Each pair of triangles crosses over a span of travels, from its least gap to its greatest; a scene
/// triangle is inside a closed object between the spans where more ways out of it than in are ahead. The
/// depth is how far the union of these spans that holds 0 reaches back. Scene triangles that face along the
/// motion do not count.
/// @param known  one that is overlapped: what is told if the search is cut short before it comes to any
Overlap overlap_depth(const TurnedTree& object, const FrontMap& front, SceneInFrame& scene,
                      const OverlappedTriangle& known, OverlapScratch& scratch);

}  // namespace roomradar
