// overlap_depth.hpp: computes the penetration depth of an object along its direction of motion.
#pragma once
#include <vector>

#include "radar/exact/scene_in_frame.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/solid_inside.hpp"

namespace roomradar {

/// Scratch memory of overlap_depth(), kept between queries.
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

/// A scene triangle in the frame of the motion, and its kind.
struct OverlappedTriangle {
  FrameTriangle triangle;
  SurfaceKind kind = SurfaceKind::kNothing;
};

struct Overlap {
  /// Distance that the object has to move against the direction of motion; 0 if there is no overlap.
  double depth_m = 0.0;
  /// False if the search was cut short. depth_m is then a lower bound.
  bool is_all = true;
  /// Last point of contact on the scene as the object moves back, in the frame of the motion, m.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Unit normal of the scene's triangle at `point`, oriented by its winding.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  SurfaceKind kind = SurfaceKind::kNothing;
};

/// Cost after which the search is cut short, in units of ColumnScratch::work (a few milliseconds). Without a
/// limit, the search for an object sunk in the ground that moves along the ground would extend to the
/// ground's end.
inline constexpr std::uint64_t kMostOverlapWork = 40'000;

/// Computes how far the object has to move back until it no longer overlaps the scene. A pair of triangles
/// intersects while the distance moved is between the pair's min and max gap. Between such intervals, a scene
/// triangle can be inside a closed object. The triangle is inside if the line through it along the motion has
/// more exits from the solid than entries ahead of the triangle. Overlapping intervals are joined. The depth
/// is the distance from 0 back to the lower end of the joined interval that contains 0. Back-facing scene
/// triangles are ignored.
/// @param known  a triangle known to overlap the object. Reported if the search is cut short before it finds
///               one
Overlap overlap_depth(const TurnedTree& object, const ObjectHeightMap& front, SceneInFrame& scene,
                      const OverlappedTriangle& known, OverlapScratch& scratch);

}  // namespace roomradar
