// change_tracker.hpp: detects lasting changes: objects that were added and stay, and objects that were
// removed.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "dynamic/foreground/foreground.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// One "sigma" is the combined standard deviation of sensor noise at the point's depth and pose error
/// (pose_sigma_m, pose_sigma_per_m).
struct ChangeTrackerConfig {
  DepthNoise noise = {};            ///< of the sensor
  float spacing_m = 0.02F;          ///< distance between the points that represent a surface
  float agree_sigmas = 2.5F;        ///< max displacement, in sigmas, of a surface that counts as unmoved
  float pose_sigma_m = 0.003F;      ///< apparent displacement of static surfaces by pose error
  float pose_sigma_per_m = 0.001F;  ///< growth of pose_sigma_m per metre of depth
  /// Max distance at which a surface in front of a point counts as the point's own surface after a motion.
  /// Such a surface contradicts the point. A surface farther in front only occludes the point.
  float own_reach_m = 0.1F;
  float link_m = 0.03F;  ///< edge of the grid cells; cells that touch form one object
  int min_cells = 8;     ///< objects with fewer cells are ignored
  /// Min fraction of an object's cells with a point that was confirmed for long enough. Rejects objects with
  /// a still middle and a moving contour, such as a swaying hand.
  float min_steady_fraction = 0.75F;
  /// Min fraction of a removed object's cells that have at least 7 neighbours. A pose error also makes
  /// surface at an edge of the map look removed, but only in a strip one or two cells wide.
  float min_core_fraction = 0.15F;
  float min_seen_fraction = 0.5F;  ///< min fraction of an object's points confirmed by the last frame
  /// Min fraction of an added object's points that were seen in front of a surface of the map. Where the map
  /// knows nothing, what stands there may always have stood there.
  float min_known_fraction = 0.5F;
  float forget_after_s = 60.0F;    ///< max ChangePoint::unseen_s; points above it are dropped
  std::size_t max_points = 20000;  ///< max number of points over all objects
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ChangeTrackerConfig& config);

enum class LastingKind : std::uint8_t {
  kCame,  ///< new object, where the static model has no surface
  kWent,  ///< removed object: the sensor sees through its surface in the model
};
/// Returns the kind's name in reports.
std::string_view to_string(LastingKind kind);

/// An object that appeared or disappeared, given as points of its surface. The points are about
/// ChangeTrackerConfig::spacing_m apart.
struct LastingChange {
  LastingKind kind = LastingKind::kCame;
  std::vector<Eigen::Vector3d> points_world;
  std::vector<std::uint32_t> ids;  ///< ids of the points, ascending
  [[nodiscard]] Eigen::AlignedBox3d box_world() const;
};

/// A point on a surface that appeared or disappeared, with its observation times.
struct ChangePoint {
  /// Relative to the tracker's origin, in the axes of the world frame.
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  float steady_s = 0.0F;  ///< total duration of the frames that confirmed the point
  float unseen_s = 0.0F;  ///< time since a frame last showed its position
  std::uint32_t id = 0;
  std::uint16_t sightings = 1;  ///< number of frames averaged into position
  /// +2 per contradicting frame, -1 per confirming one; above 7, the point is dropped.
  std::uint8_t contradiction = 0;
  bool as_it_was = true;    ///< confirmed by the last frame
  bool before_map = false;  ///< a frame that confirmed it saw it in front of a surface of the map
  LastingKind kind = LastingKind::kCame;
};

/// A cell of the grid (a cube of edge link_m) that contains points.
struct ChangeCell {
  std::uint64_t code = 0;       ///< voxel_key() of the cube
  std::uint32_t joined_to = 0;  ///< parent cell in a union-find forest; a root is its own parent
  bool steady = false;          ///< contains a point that was confirmed for long enough
  std::uint8_t neighbours = 0;  ///< number of touching cells, corners included
};

/// Sums over the connected cells of one object. Steady cells have ChangeCell::steady set, core cells have at
/// least 7 neighbours, seen points were confirmed by the last frame, and known points are before_map.
struct ChangeObject {
  int cells = 0, steady_cells = 0, core_cells = 0;
  std::size_t points = 0, seen_points = 0, known_points = 0;
  std::size_t change = 0;  ///< 1 + index among the changes found; 0: rejected
};

/// Buffers of the grouping, reused from call to call.
struct ChangeClusters {
  std::vector<ChangeCell> cells;
  std::vector<ChangeObject> objects;   ///< indexed by an object's root cell
  std::vector<std::uint32_t> cell_of;  ///< per point; 0xFFFFFFFF for points of the other kind
  std::vector<std::uint32_t> table;    ///< hash table of cells by code; 0xFFFFFFFF: empty slot
};

/// Reserves memory for max_points points, so later calls do not allocate.
void reserve(std::size_t max_points, ChangeClusters& clusters);

/// Fills `cells` and `cell_of` from the points of one kind, and connects cells in the 26-neighbourhood.
/// @param seconds  min steady_s of a point that makes its cell steady
/// @param link_m   edge of the cells
void sort_into_cells(std::span<const ChangePoint> points, LastingKind kind, float seconds, float link_m,
                     ChangeClusters& clusters);

/// Appends the objects that reach the thresholds of ChangeTrackerConfig: min_cells, and the min fractions of
/// steady cells, core cells (kWent only), seen points and known points (kCame only). Call after
/// sort_into_cells() with the same points and kind.
void add_objects(std::span<const ChangePoint> points, LastingKind kind, const Eigen::Vector3d& origin_world,
                 const ChangeTrackerConfig& config, ChangeClusters& clusters,
                 std::vector<LastingChange>& changes);

/// Stores world points on dynamic and on removed surfaces, and projects them into every depth image. A frame
/// confirms a point on a dynamic surface if it measures the surface at the point. A frame confirms a point on
/// a removed surface if it sees through the point. Only confirming frames add to the point's steady_s. A
/// frame that measures the point's position but does not confirm the point contradicts it. The point is
/// dropped once its contradiction score exceeds 7 (ChangePoint::contradiction). Hidden points and points out
/// of view keep their score and steady_s. Hence the result does not depend on the camera's motion. Allocates
/// nothing after the first frame except the changes it returns. Not thread safe.
class ChangeTracker {
 public:
  explicit ChangeTracker(const ChangeTrackerConfig& config = {});

  /// Sets the noise of the sensor of later frames.
  void set_noise(const DepthNoise& noise) { config_.noise = noise; }
  /// Processes one frame. Images must have the camera's size. `labels` must be the result of
  /// mark_foreground() for this depth and expected depth. stamp_s is the frame's time. A gap between two
  /// frames counts as at most 0.5 s.
  void update(const DepthImage& depth_m, const DepthImage& expected_depth_m, const LabelImage& labels,
              const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double stamp_s);

  /// Returns the objects that were confirmed for at least this many seconds and are in view now. Later calls
  /// return an object again until it is forgotten, moves, or agrees with the expected depth.
  [[nodiscard]] std::vector<LastingChange> lasting_changes(double seconds);

  /// Returns the fraction of a change's points that have not been dropped.
  [[nodiscard]] double still_true(const LastingChange& change) const;
  /// Returns the fraction of a change's points that the last frame confirmed.
  [[nodiscard]] double seen_now(const LastingChange& change) const;
  /// Drops a change's points, so lasting_changes() no longer returns the change.
  void forget(const LastingChange& change);

  [[nodiscard]] std::size_t point_count() const { return points_.size(); }

 private:
  struct View;  // images, camera and pose of one frame

  /// Updates a point from the frame. Returns false if the point must be dropped.
  bool review(const View& view, float dt_s, ChangePoint& point);
  void add_points(const View& view);
  void cover(const View& view, LastingKind kind, float u_px, float v_px, float depth_m);

  ChangeTrackerConfig config_;
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();  ///< camera position in the first frame
  bool has_origin_ = false;
  double last_stamp_s_ = 0.0;
  std::uint32_t next_id_ = 1;
  std::vector<ChangePoint> points_;  ///< sorted by id
  /// Bits per pixel of the sampling grid. Bit 1 << kind: a point of that kind covers the pixel.
  std::vector<std::uint8_t> covered_;
  ChangeClusters clusters_;
};

}  // namespace roomradar
