// cyber_radar.hpp: computes the distance to contact of an object that moves along a line, exactly or within
// bounds.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/exact/contact_patch.hpp"
#include "radar/exact/object_front.hpp"
#include "radar/exact/overlap_depth.hpp"
#include "radar/exact/radar.hpp"
#include "radar/exact/radar_query.hpp"
#include "radar/exact/scene_in_frame.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

struct RadarSearch;

/// Cyber Radar on the CPU. M is the object's height map: its leading surface, seen against the motion. R is
/// the scene ahead of M. L is the gap between M and R. The minimum of L is the distance to contact. Below, u
/// is the direction of motion and n a scene triangle's normal.
///
///   1. M: per pixel, an upper bound of the object's height along u (ObjectHeightMap). M is kept while the
///      object's tree and the direction in the object's frame are unchanged.
///   2. R: the scene's bounding boxes, from large to small, nearest first (SceneInFrame). Lower
///      bound of the distance to every contact in a box: the box's least height minus the greatest M below
///      it. For a triangle, the bound is computed from the triangle's plane in each pixel of M.
///   3. L: the triangle with the least bound gets the exact test, in double, against all object triangles
///      that overlap it in projection (search_column, find_gap, classify_pair). The least distance found is
///      an upper bound of the result. The least bound of the untested triangles is a lower bound. Once the
///      two bounds agree, they are the exact result.
///
/// Triangles thinner than a pixel enter M and R with their whole bounding boxes, so the bounds include them.
/// A scene surface inside a concavity of the object is behind M. Its gap to M is negative, which is no
/// contact with M. The exact test compares it with the object surfaces behind it.
///
/// Exactness: the error is that of double arithmetic on the float vertices, about 1e-12 m in a room and 1e-9
/// m at a million metres from the world's origin.
///
/// Touching: surfaces closer than touching_m() touch. Touching a surface that faces against the motion (n . u
/// < 0) is a contact at distance 0. Touching a surface parallel to the motion is not a contact. Touching a
/// back-facing surface (n . u > 0) is not a contact either, since the object moves away from it.
///
/// Overlap: surfaces that intersect by more than touching_m(), or scene surfaces inside a closed object
/// (TriangleTree::is_closed()). Back-facing scene triangles do not count. Each pair of triangles intersects
/// over an interval of the distance moved. A scene surface is inside a closed object over such intervals,
/// too. Overlapping intervals are joined. The lower end of the joined interval that contains 0 is
/// contact_distance_m = lower_m = upper_m. Moved back this far, the object no longer overlaps the scene. An
/// object sunk in the ground that moves along the ground overlaps it up to the ground's end. The search
/// therefore stops at a work limit (kMostOverlapWork). The result is then the joined interval found so far:
/// contact_distance_m = upper_m is its lower end, and lower_m is -infinity.
///
/// Sliding: a scene triangle parallel to the motion (|n . u| <= 1e-9) is no contact for an object triangle
/// wholly on one side of the scene triangle's plane. So an object with edges exactly in an open scene
/// sheet passes along the sheet.
///
/// Leaving: an object that intersects a back-facing surface now is leaving that surface. The object
/// intersects back-facing surfaces over intervals of the distance moved. Overlapping intervals are joined,
/// starting at 0. Back-facing surfaces cause no contact before the end of the joined interval. Example: a cup
/// is drawn off a hand in its handle, and the handle's bar has to pass the hand.
///
/// One-sided surfaces (is_one_sided()) are touched from their outside only. Their back-facing triangles are
/// always ignored.
///
/// Contact point: of all equally near points (for example those of a face that lands flat), the one nearest
/// to their centroid. At most ContactPatch::kMaxPieces pairs of triangles contribute.
///
/// Uses no OpenGL. Not thread safe: use one radar per thread; trees and images may be shared.
class CyberRadar final : public Radar {
 public:
  explicit CyberRadar(const RadarConfig& config = {});

  /// Computes the first contact. Never throws. Allocates nothing once queries of this size have been run.
  ///
  /// Returns kInvalidInput for an invalid query or scene:
  /// - query: direction zero or not finite; distance not finite or <= 0; margin negative or not finite;
  /// object
  ///   without triangles, or with a pose that is not finite
  /// - scene: a pose that is not finite; an unusable camera; a mask of another size than its depth image; a
  ///   stride below 1; a jump limit that is negative or NaN
  ///
  /// Sampled mode stops once it has found a contact,
  /// has run kSampledExactTests exact tests, and the lower bounds of all untested surfaces are at least 0,
  /// unless the object is leaving a back-facing surface.
  /// Exact mode stops once no untested surface can be nearer.
  Contact query(const RadarQuery& query, const RadarScene& scene) override;

  [[nodiscard]] const RadarConfig& config() const { return config_; }
  /// Returns the number of bounds that all queries so far have computed from the planes of
  /// SurfaceKind::kStatic triangles. Triangles smaller than a pixel of M are not counted.
  [[nodiscard]] std::uint64_t static_triangles_tested() const { return static_triangles_asked_; }

  /// Minimum number of exact tests before sampled mode stops.
  static constexpr int kSampledExactTests = 48;
  /// Cost of a query at which surfaces that may be behind M are left untested, in units of
  /// ColumnScratch::work; a few milliseconds. The limit is reached if the object is sunk in a very fine mesh,
  /// or if a very fine mesh lies in a concavity of the object. lower_m is then 0 in exact mode too, and
  /// back-facing surfaces cause no contact.
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
  [[nodiscard]] double least_untested_m(const RadarSearch& search) const;
  [[nodiscard]] Contact nothing_found(const RadarSearch& search) const;
  [[nodiscard]] Contact inflated_contact_of(const RadarSearch& search) const;
  [[nodiscard]] Contact overlap_of(const RadarSearch& search);
  [[nodiscard]] Contact contact_of(RadarSearch& search);
};

}  // namespace roomradar
