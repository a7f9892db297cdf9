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

/// Cyber Radar on the CPU. M is the object's height map: the leading surface as seen from ahead. R is the
/// scene ahead of it. L is the gap between them; its minimum is the distance to contact. Below, u is the
/// direction of motion and n a scene triangle's normal.
///
///   1. M: per pixel, an upper bound of the object's height along u (ObjectHeightMap). Kept while the
///      object's tree and the direction in its frame are unchanged.
///   2. R: the scene's bounding boxes, from large to small, nearest first (SceneInFrame). A box's least
///      height minus the greatest M under the box is a lower bound of the distance to every contact in it.
///      For a triangle, the bound is computed from its plane over each pixel of M.
///   3. L: the triangle with the least bound gets the exact test, in double, against all object triangles
///      that overlap it in projection (search_column, find_gap, classify_pair). The least distance found is
///      an upper bound of the result, and the least untested bound a lower one. Once they agree, both are
///      exact.
///
/// Triangles thinner than a pixel enter M and R with their whole bounding boxes, so the bounds include them.
/// Scene inside a concavity of the object is behind M, and a negative gap to M is not a contact there. The
/// exact test compares such scene with the object's surfaces behind it.
///
/// Exactness: the error is that of double arithmetic on the float vertices, about 1e-12 m in a room and 1e-9
/// m at a million metres from the world's origin.
///
/// Touching: surfaces closer than touching_m() touch. Touching a surface that faces against the motion (n . u
/// < 0) is a contact at distance 0. Touching a back-facing surface (n . u > 0, the object moves away from it)
/// or a surface parallel to the motion is not a contact.
///
/// Overlap: surfaces that intersect by more than touching_m(), or scene inside a closed object
/// (TriangleTree::is_closed()). Back-facing scene triangles do not count. Each pair of triangles intersects
/// over an interval of the distance moved, and so does scene inside a closed object. contact_distance_m =
/// lower_m = upper_m is the lower end of the connected union of intervals that contains 0: the object is
/// clear after moving back this far. An object that is sunk in the ground and moves along it is clear only
/// where the ground ends, so the search stops at a work limit (kMostOverlapWork). Then contact_distance_m =
/// upper_m is the lower end of the union found so far, and lower_m is -infinity.
///
/// Sliding: a scene triangle that is exactly parallel to the motion (|n . u| <= 1e-9) is no contact for
/// object triangles wholly on one side of it. An open sheet that runs exactly along edges of the object's
/// mesh is therefore not touched by the triangles on either side.
///
/// Leaving: the object is leaving a back-facing surface that it intersects now. Other back-facing surfaces
/// are ignored too if the object will intersect one or another of them without interruption from now on.
/// Example: a cup leaves a hand that is in its handle, and the handle's bar is still behind the hand. These
/// surfaces cause no contact until the object has passed the last of them.
///
/// One-sided surfaces (is_one_sided()) are touched from their outside only: their back-facing triangles are
/// always ignored.
///
/// Contact point: the one nearest to the centroid of all equally near points, for example those of a face
/// that lands flat. At most ContactPatch::kMaxPieces pairs of triangles contribute.
///
/// No GL. Not thread safe: use one radar per thread; trees and images may be shared.
class CyberRadar {
 public:
  explicit CyberRadar(const RadarConfig& config = {});

  /// Computes the first contact. Never throws. Allocates nothing once queries of this size have been run.
  ///
  /// Returns kInvalidInput if the direction is zero or not finite, the distance is not finite or <= 0, the
  /// margin is negative or not finite, the object has no triangles, a pose of object or scene is not finite,
  /// a camera is unusable, a mask's size differs from its depth image's, a stride is below 1, or a jump limit
  /// is negative or NaN. Sampled mode stops once it has a contact, has run kSampledExactTests exact tests,
  /// and nothing untested may overlap. Exact mode stops once nothing untested can be nearer.
  Contact query(const RadarQuery& query, const RadarScene& scene);

  [[nodiscard]] const RadarConfig& config() const { return config_; }
  /// Returns the number of SurfaceKind::kStatic triangles examined individually by all queries so far.
  /// Triangles smaller than a pixel of M are not counted.
  [[nodiscard]] std::uint64_t static_triangles_tested() const { return static_triangles_asked_; }

  /// Minimum number of exact tests before sampled mode stops.
  static constexpr int kSampledExactTests = 48;
  /// Max cost of testing scene behind M, in units of ColumnScratch::work; a few milliseconds. Reached if the
  /// object is sunk in a very fine mesh, or if such a mesh lies in a concavity of the object. Then lower_m is
  /// 0 in exact mode too, and back-facing surfaces cause no contact.
  static constexpr std::uint64_t kMostWorkBehind = 40'000;

 private:
  /// A back-facing scene triangle, and the interval of distance moved over which an object triangle
  /// intersects it.
  struct Back {
    double low_m, high_m;
    std::uint32_t object_triangle;
    SceneItem item;
  };
  RadarConfig config_;
  // M: the object's height map.
  ObjectFront front_;
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
