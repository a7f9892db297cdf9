// cyber_radar.hpp: how far may an object go before it touches? Exactly, or between bounds that hold.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "mapping/types/image.hpp"
#include "radar/exact/contact_patch.hpp"
#include "radar/exact/object_height_map.hpp"
#include "radar/exact/overlap_depth.hpp"
#include "radar/exact/scene_in_frame.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

enum class RadarMode {
  kSampled,  ///< settles few triangles exactly: fast, the bounds are as wide as a pixel is deep
  kExact     ///< settles until lower_m = upper_m = travel_m
};
constexpr std::string_view to_string(RadarMode mode) {
  return mode == RadarMode::kExact ? "exact" : "sampled";
}

struct RadarConfig {
  RadarMode mode = RadarMode::kExact;
  /// Pixels along the longer side of the object's outline, 1 to 4096: how wide the bounds of sampled mode
  /// are once a direction of the object's own frame has come so often that a finer M pays (before, M has 40
  /// at most, or 64 of an object of few triangles), and Contact::pixel_m. Exact mode takes as many pixels as
  /// is fastest; its answer does not depend on them.
  int resolution_px = 64;
  friend bool operator==(const RadarConfig&, const RadarConfig&) = default;
};
/// @throws Error naming the field, its value and the rule
void require_valid(const RadarConfig& config);

struct RadarQuery {
  TreeInstance object;                                        ///< not in the scene, but for own_tree
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();  ///< any length but 0
  double distance_m = 0.0;                                    ///< how far ahead to look, > 0
  /// The object is thickened by this all round: lower_m then holds for any motion that strays no farther from
  /// the straight one (turning, noise). > 0: only lower_m is of use; upper_m is infinite, overlap and
  /// touching are lower_m = 0, and what the object leaves counts as well.
  double margin_m = 0.0;
  /// Which of the scene's trees is the object itself, and is left out.
  std::size_t own_tree = kNotInScene;
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
};

/// Whether it can be asked: see CyberRadar::query() for what cannot.
bool is_valid(const RadarQuery& query);

/// Cyber Radar on the processor: M, the object's leading surface, against R, the scene ahead; the least gap
/// L between them is the way to go.
///
///  1. M: for each pixel the greatest height that the object may have anywhere in it (FrontMap). Kept while
///     the object's tree and the direction in its frame stay.
///  2. R: the scene's boxes, large to small, nearest first (SceneInFrame). A box's least height less the
///     greatest M under it is a lower bound of every contact in it; for a triangle, that of its plane over
///     each of M's pixels.
///  3. L: what has the least bound is settled: the scene's triangle against the object's triangles in its
///     column, all layers of them, in double (search_column, find_gap, meeting_of). The least travel settled
///     is an upper bound; the least bound unsettled is a lower one; when they meet, both are the truth.
///
/// Needles and sheets thinner than a pixel are in M and in R with their whole boxes, so neither bound misses
/// them. Scene in a hollow of a concave object is behind the front layer, whose gap is negative and says
/// nothing; the layer behind it is met if there is one.
///
/// Exact means: the error is that of double arithmetic on the float vertices, some 1e-12 m in a room and 1e-9
/// m at a million metres from the world's origin.
///
/// Touching: surfaces nearer than touching_m() touch. Touching what opposes the motion is a contact after 0;
/// touching what faces along the motion (what the object leaves) or slides along it is none. An overlap is a
/// pair of surfaces that cross by more than that, or scene inside a closed object
/// (TriangleTree::is_closed()), unless the scene's triangle faces along the motion. travel_m = lower_m =
/// upper_m is then minus the way back along the direction until the object is free: the near end of the union
/// of all pairs' spans of crossing, the inside of a closed object included, that holds 0. Where that is long
/// (an object that is sunk in the ground and moves along it is free again where the ground ends) the search
/// is cut short (kMostOverlapWork): travel_m = upper_m is then how far the union reaches for certain, and
/// lower_m minus infinity.
///
/// Sliding: a scene triangle exactly edge-on (|n . u| <= 1e-9) that has an object triangle wholly on one side
/// is slid along by that triangle. So an open sheet that runs exactly along edges of the object's mesh is not
/// met by the triangles on either side.
///
/// Leaving: what faces along the motion and crosses the object now is left, and all that faces so and is
/// crossed without a break from now on is left with it, also where a part of the object is still behind it
/// (the bar of a handle behind a hand that is in the handle): no contact until the last of it has been
/// passed.
///
/// One-sided surfaces (is_one_sided()) are met from their outside only: what of them faces along the motion
/// is left, wherever it is.
///
/// Contact point: of all places that are equally near (a face that lands flat; ContactPatch::kMostPieces
/// pairs of triangles are counted) the one nearest to their middle.
///
/// No GL. Not thread safe: one radar a thread; trees and images may be shared.
class CyberRadar {
 public:
  explicit CyberRadar(const RadarConfig& config = {});

  /// Never throws, allocates nothing after the first queries of a size.
  ///
  /// kInvalidInput: direction zero or not finite, distance not finite or <= 0, margin negative or not finite,
  /// object without triangles, a pose of object or scene not finite, a camera that cannot be one, a mask of
  /// another size than its depth image, a jump that is negative or no number.
  /// Sampled mode settles until a contact is found and kSampledSettles triangles are settled, and all that
  /// may overlap; exact until nothing unsettled can be nearer.
  Contact query(const RadarQuery& query, const RadarScene& scene);

  [[nodiscard]] const RadarConfig& config() const { return config_; }
  /// Triangles of Touched::kStatic that were looked at one by one so far, by all queries.
  [[nodiscard]] std::uint64_t static_triangles_asked() const { return static_triangles_asked_; }

  static constexpr int kSampledSettles = 48;
  /// What an object that is sunk in a very fine mesh, or holds one in its hollow, may cost before it is left
  /// at that: some milliseconds. lower_m is then 0 in exact mode too, and no surface that faces along the
  /// motion counts as found.
  static constexpr std::uint64_t kMostWorkBehind = 40'000;

 private:
  /// A scene triangle that faces along the motion, and from which travel to which an object triangle crosses
  /// it.
  struct Back {
    double low_m, high_m;
    std::uint32_t object_triangle;
    SceneItem item;
  };
  RadarConfig config_;
  FrontMap front_;
  std::uint64_t static_triangles_asked_ = 0;
  std::uint64_t front_work_ = 0;  // of all queries with front_ as it is turned now, as ColumnScratch::work
  SceneInFrame scene_;
  ContactPatch patch_;
  OverlapScratch overlap_;
  std::vector<SceneItem> heap_;
  std::vector<SceneItem> found_;
  ColumnScratch columns_;
  std::vector<Back> backs_;
  std::vector<Layer> layers_;
  Eigen::Vector3d u_mesh_ = Eigen::Vector3d::Zero();

  struct Search;
  Eigen::Vector3d direction_in_object(const RadarQuery& query);
  void build_front(const TurnedTree& object, bool is_kept);
  [[nodiscard]] int fresh_px() const;
  [[nodiscard]] Eigen::AlignedBox3d volume_ahead(const Search& search) const;
  [[nodiscard]] SceneBound bound_of(const Search& search) const;
  void look(Search& search);
  void settle(Search& search, const SceneItem& item, const FrameTriangle& s);
  void look_over(Search& search, const Eigen::Vector2d& place);
  void cut_short(Search& search);
  void leave(Search& search);
  [[nodiscard]] double limit_m(const Search& search) const;
  [[nodiscard]] double least_unsettled_m(const Search& search) const;
  [[nodiscard]] Contact nothing_found(const Search& search) const;
  [[nodiscard]] Contact thick_contact_of(const Search& search) const;
  [[nodiscard]] Contact overlap_of(const Search& search);
  [[nodiscard]] Contact contact_of(Search& search);
  static void touch(const Search& search, const PatchPoint& at, Contact& contact);
};

/// Surfaces of this object that are nearer to the scene than this touch it, m: 1 um and what float vertices
/// of its size cannot tell apart.
double touching_m(const TriangleTree& object);

}  // namespace roomradar
