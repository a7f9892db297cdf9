// cyber_radar.hpp: distance an object can move along a line before contact, exact or between bounds.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/exact/contact_patch.hpp"
#include "radar/exact/object_front.hpp"
#include "radar/exact/overlap_depth.hpp"
#include "radar/exact/radar_query.hpp"
#include "radar/exact/scene_in_frame.hpp"
#include "radar/exact/scene_queue.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

struct RadarSearch;

/// Cyber Radar on the CPU. M is the object's leading surface, R the scene ahead; the least gap L between them
/// is the distance to contact. Below, u is the direction of motion and n a scene triangle's normal.
///
///   1. M: per pixel, an upper bound of the object's height (ObjectHeightMap). Kept while the object's tree
///   and the
///      direction in its frame are unchanged.
///   2. R: the scene's boxes, large to small, nearest first (SceneInFrame). A box's least height minus the
///      greatest M under it is a lower bound for every contact in it. For a triangle, the bound comes from
///      its plane over each pixel of M.
///   3. L: the triangle with the least bound gets the exact test: in double, against all layers of object
///      triangles in its column (search_column, find_gap, classify_pair). The least distance found is an
///      upper bound and the least untested bound a lower one. Once they agree, both are exact.
///
/// Needles and sheets thinner than a pixel enter M and R with their whole boxes, so neither bound misses
/// them. Scene in a hollow of a concave object is behind the front layer; its negative gap to that layer is
/// no contact. The object's next layer behind that scene touches it, if there is one.
///
/// Exactness: the error is that of double arithmetic on the float vertices, about 1e-12 m in a room and 1e-9
/// m at a million metres from the world's origin.
///
/// Touching: surfaces closer than touching_m() touch. Touching a surface that faces against the motion (n . u
/// < 0) is a contact after 0. Touching a back-facing one (n . u > 0, which the object leaves), or one that
/// slides along, is no contact.
///
/// Overlap: surfaces that cross by more than touching_m(), or scene inside a closed object
/// (TriangleTree::is_closed()), unless the scene's triangle is back-facing. Each pair of triangles crosses
/// over an interval of travel; so does scene inside a closed object. contact_distance_m = lower_m = upper_m
/// is the lower end of the union of intervals that contains 0: the object is clear after moving back this
/// far. An object that is sunk in the ground and moves along it is clear only where the ground ends, so a
/// long search is cut short (kMostOverlapWork). Then contact_distance_m = upper_m is the part of the union
/// found so far, and lower_m is -infinity.
///
/// Sliding: an object triangle wholly on one side of a scene triangle that is exactly edge-on (|n . u| <=
/// 1e-9) slides along it. An open sheet that runs exactly along edges of the object's mesh is therefore not
/// touched by the triangles on either side.
///
/// Leaving: a back-facing surface that crosses the object now is left. All back-facing surfaces crossed
/// without a break from now on are left with it, even if part of the object is still behind them (the bar of
/// a handle behind a hand in the handle). They cause no contact until the last of them is passed.
///
/// One-sided surfaces (is_one_sided()) are touched from their outside only: their back-facing triangles are
/// always ignored.
///
/// Contact point: the one nearest to the centroid of all equally near points, such as those of a face that
/// lands flat. At most ContactPatch::kMaxPieces pairs of triangles are counted.
///
/// No GL. Not thread safe: use one radar per thread; trees and images may be shared.
class CyberRadar {
 public:
  explicit CyberRadar(const RadarConfig& config = {});

  /// Computes the first contact. Never throws; allocates nothing after the first queries of a size.
  ///
  /// Returns kInvalidInput if the direction is zero or not finite, the distance not finite or <= 0, the
  /// margin negative or not finite, the object without triangles, a pose of object or scene not finite, a
  /// camera unusable, a mask not of its depth image's size, a stride below 1, or a jump limit negative or
  /// NaN. Sampled mode stops once it has a contact, has run kSampledExactTests exact tests, and nothing
  /// untested may overlap. Exact mode stops once nothing untested can be nearer.
  Contact query(const RadarQuery& query, const RadarScene& scene);

  [[nodiscard]] const RadarConfig& config() const { return config_; }
  /// Number of SurfaceKind::kStatic triangles examined one by one so far, over all queries; triangles smaller
  /// than a pixel of M are not counted.
  [[nodiscard]] std::uint64_t static_triangles_tested() const { return static_triangles_asked_; }

  static constexpr int kSampledExactTests = 48;
  /// Limit of work (see ColumnScratch) on scene behind the object's front, some milliseconds. Reached by an
  /// object that is sunk in a very fine mesh or has one in its hollow. Beyond it lower_m is 0 in exact mode
  /// too, and back-facing surfaces cause no contact.
  static constexpr std::uint64_t kMostWorkBehind = 40'000;

 private:
  /// A back-facing scene triangle, and the interval of travel over which an object triangle crosses it.
  struct Back {
    double low_m, high_m;
    std::uint32_t object_triangle;
    SceneItem item;
  };
  RadarConfig config_;
  ObjectFront front_;  // M
  std::uint64_t static_triangles_asked_ = 0;
  SceneInFrame scene_;
  ContactPatch patch_;
  OverlapScratch overlap_;
  SceneQueue queue_;
  std::vector<SceneItem> found_;
  ColumnScratch columns_;
  std::vector<Back> backs_;
  std::vector<Layer> layers_;

  [[nodiscard]] Eigen::AlignedBox3d volume_ahead(const RadarSearch& search) const;
  [[nodiscard]] SceneBound bound_of(const RadarSearch& search) const;
  void look(RadarSearch& search);
  void test_exactly(RadarSearch& search, const SceneItem& item, const FrameTriangle& s);
  void look_over(RadarSearch& search, const Eigen::Vector2d& place);
  void cut_short(RadarSearch& search);
  void leave(RadarSearch& search);
  [[nodiscard]] double limit_m(const RadarSearch& search) const;
  [[nodiscard]] double least_unsettled_m(const RadarSearch& search) const;
  [[nodiscard]] Contact nothing_found(const RadarSearch& search) const;
  [[nodiscard]] Contact inflated_contact_of(const RadarSearch& search) const;
  [[nodiscard]] Contact overlap_of(const RadarSearch& search);
  [[nodiscard]] Contact contact_of(RadarSearch& search);
};

}  // namespace roomradar
