// cyber_radar.hpp: computes how far an object can move along a line before contact, exactly or within bounds.
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

/// Cyber Radar on the CPU. M is the object's height map: its leading surface, seen against the motion. R is
/// the scene ahead of M. L is the gap between M and R; its minimum is the distance to contact. Below, u is
/// the direction of motion and n a scene triangle's normal.
///
///   1. M: per pixel, an upper bound of the object's height along u (ObjectHeightMap). M is kept while the
///      object's tree and the direction in the object's frame are unchanged.
///   2. R: the scene's bounding boxes, from large to small, nearest first (SceneInFrame). A box's least
///      height minus the greatest M under the box is a lower bound of the distance to every contact in the
///      box. For a triangle, the bound is computed from the triangle's plane in each pixel of M.
///   3. L: the triangle with the least bound gets the exact test, in double, against all object triangles
///      that overlap it in projection (search_column, find_gap, classify_pair). The least distance found is
///      an upper bound of the result, and the least bound of the untested triangles is a lower bound. Once
///      the two bounds agree, they are the exact result.
///
/// Triangles thinner than a pixel enter M and R with their whole bounding boxes, so the bounds include them.
/// A scene surface inside a concavity of the object is behind M. Its gap to M is negative, which is not a
/// contact. The exact test compares such a surface with those object surfaces that are behind the scene
/// surface.
///
/// Exactness: the error is that of double arithmetic on the float vertices, about 1e-12 m in a room and 1e-9
/// m at a million metres from the world's origin.
///
/// Touching: surfaces closer than touching_m() touch. Touching a surface that faces against the motion (n . u
/// < 0) is a contact at distance 0. Touching a surface parallel to the motion is not a contact, nor is
/// touching a back-facing surface (n . u > 0), since the object moves away from it.
///
/// Overlap: surfaces that intersect by more than touching_m(), or scene surfaces inside a closed object
/// (TriangleTree::is_closed()). Back-facing scene triangles do not count. Each pair of triangles intersects
/// over an interval of the distance moved, and a scene surface is inside a closed object over such intervals
/// too. Overlapping intervals are joined. The lower end of the joined interval that contains 0 is
/// contact_distance_m = lower_m = upper_m: the object is clear after moving back this far. An object that is
/// sunk in the ground and moves along the ground is clear only where the ground ends, so the search stops at
/// a work limit (kMostOverlapWork). Then contact_distance_m = upper_m is the lower end of the joined interval
/// found so far, and lower_m is -infinity.
///
/// Sliding: a scene triangle parallel to the motion (|n . u| <= 1e-9) is no contact for an object triangle
/// that lies wholly on one side of its plane. If the edges of object triangles lie exactly in an open scene
/// sheet, the object therefore passes the sheet without contact.
///
/// Leaving: the object is leaving a back-facing surface that it intersects now. The intervals of the distance
/// moved over which the object intersects back-facing surfaces are joined, from 0 on, as long as they
/// overlap. Back-facing surfaces cause no contact before the end of the joined interval. Example: a cup
/// leaves a hand that is in its handle, and the handle's bar is behind the hand and has to pass it.
///
/// One-sided surfaces (is_one_sided()) are touched from their outside only: their back-facing triangles are
/// always ignored.
///
/// Contact point: of all equally near points (for example those of a face that lands flat), the one nearest
/// to their centroid. At most ContactPatch::kMaxPieces pairs of triangles contribute.
///
/// Uses no OpenGL. Not thread safe: use one radar per thread; trees and images may be shared.
class CyberRadar {
 public:
  explicit CyberRadar(const RadarConfig& config = {});

  /// Computes the first contact. Never throws. Allocates nothing once queries of this size have been run.
  ///
  /// Returns kInvalidInput if the direction is zero or not finite, the distance is not finite or <= 0, the
  /// margin is negative or not finite, the object has no triangles, a pose of object or scene is not finite,
  /// a camera is unusable, a mask's size differs from its depth image's, a stride is below 1, or a jump limit
  /// is negative or NaN. Sampled mode stops once three conditions hold: it has found a contact, it has run
  /// kSampledExactTests exact tests, and the lower bounds of all untested surfaces are at least 0. Exact mode
  /// stops once no untested surface can be nearer.
  Contact query(const RadarQuery& query, const RadarScene& scene);

  [[nodiscard]] const RadarConfig& config() const { return config_; }
  /// Returns the number of SurfaceKind::kStatic triangles for which the queries so far computed a bound from
  /// the triangle's plane. Triangles smaller than a pixel of M are not counted.
  [[nodiscard]] std::uint64_t static_triangles_tested() const { return static_triangles_asked_; }

  /// Minimum number of exact tests before sampled mode stops.
  static constexpr int kSampledExactTests = 48;
  /// Max cost of a query that tests scene surfaces behind M, in units of ColumnScratch::work; a few
  /// milliseconds. The limit is reached if the object is sunk in a very fine mesh, or if a very fine mesh
  /// lies in a concavity of the object. Surfaces that may be behind M are then left untested: lower_m is 0 in
  /// exact mode too, and back-facing surfaces cause no contact.
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
