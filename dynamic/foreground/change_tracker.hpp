// change_tracker.hpp: detects lasting changes: objects that came to stay, and objects removed for good.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "dynamic/foreground/foreground.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

enum class LastingKind : std::uint8_t {
  kCame,  ///< present where the static model has nothing
  kWent,  ///< in the static model, but the sensor sees through it
};
/// Returns the name used in reports.
std::string_view to_string(LastingKind kind);

/// An object that came or went, as points of its surface about spacing_m apart.
struct LastingChange {
  LastingKind kind = LastingKind::kCame;
  std::vector<Eigen::Vector3d> points_world;
  std::vector<std::uint32_t> ids;  ///< of the points, ascending: the tracker's keys
  [[nodiscard]] Eigen::AlignedBox3d box_world() const;
};

/// "Sigmas" combine sensor noise at that depth with pose and model error, added as variances.
struct ChangeTrackerConfig {
  float spacing_m = 0.02F;          ///< between the points that represent a surface
  float agree_sigmas = 2.5F;        ///< a surface within this distance of its former place has not moved
  float pose_sigma_m = 0.003F;      ///< apparent displacement of static surfaces between frames
  float pose_sigma_per_m = 0.001F;  ///< its growth per metre of depth
  /// A surface in front of a point by less than this is the point's own surface, moved. A surface in front by
  /// more is an occluder, and the point's state is unknown meanwhile.
  float own_reach_m = 0.1F;
  float link_m = 0.03F;  ///< edge of the cells; touching cells, corners included, form one object
  int min_cells = 8;     ///< objects with fewer cells are ignored
  /// An object settles as a whole: min fraction of its cells with a point that stayed. Rejects an object
  /// whose middle holds still while its rim moves, such as a swaying hand.
  float min_steady_fraction = 0.75F;
  /// kWent: min fraction of an object's cells that are interior, with neighbours all round. A map edge
  /// displaced by a pose error is seen through as well, but in a strip one or two cells wide.
  float min_core_fraction = 0.15F;
  float min_seen_fraction = 0.5F;  ///< min fraction of its points confirmed by this frame
  float forget_after_s = 60.0F;    ///< points unseen for this long are dropped
  std::size_t max_points = 20000;  ///< of all objects together; at this number no point is added
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ChangeTrackerConfig& config);

/// Keeps points on dynamic and on removed surfaces in the world, and looks up each in every depth image.
/// While its surface is where it was (for a removed surface, while it is seen through), a point's time grows.
/// A contradicted point is dropped after a few frames. While a point is hidden or out of view, its time
/// stands still, so the result does not depend on the camera's motion. Allocates nothing after the first
/// frame except the changes it returns. Not thread safe.
class ChangeTracker {
 public:
  explicit ChangeTracker(const ChangeTrackerConfig& config = {});

  /// Processes one frame. Images must have the camera's size; labels are those of mark_foreground() for this
  /// depth and expected depth. stamp_s is the frame's time; a gap counts as at most 0.5 s.
  void update(const DepthImage& depth_m, const DepthImage& expected_depth_m, const LabelImage& labels,
              const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double stamp_s);

  /// Returns the objects that were unchanged for this many seconds of observation and are seen now. Every
  /// call returns the same object again until it is forgotten, moves, or agrees with the expected depth.
  [[nodiscard]] std::vector<LastingChange> settled(double seconds);

  /// Returns the fraction of a change's points that have not been dropped.
  [[nodiscard]] double still_true(const LastingChange& change) const;
  /// Returns the fraction of a change's points that the last frame confirmed.
  [[nodiscard]] double seen_now(const LastingChange& change) const;
  /// Drops a change's points.
  void forget(const LastingChange& change);

  [[nodiscard]] std::size_t point_count() const { return points_.size(); }

 private:
  struct Point {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to origin_world_
    float steady_s = 0.0F;                               ///< total time confirmed
    float unseen_s = 0.0F;                               ///< time since it was last seen
    std::uint32_t id = 0;
    std::uint16_t sightings = 1;
    std::uint8_t doubt = 0;
    bool as_it_was = true;  ///< confirmed by the last frame
    LastingKind kind = LastingKind::kCame;
  };
  struct Cell {
    std::uint64_t code = 0;
    std::uint32_t joined_to = 0;  ///< parent in a union-find forest; a root is its own parent
    bool steady = false;          ///< one of its points stayed for long enough
    std::uint8_t neighbours = 0;  ///< number of cells that touch it
  };
  struct Thing {
    int cells = 0, steady_cells = 0, core_cells = 0;
    std::size_t points = 0, seen_points = 0;
    std::size_t change = 0;  ///< 1 + index among the changes found; 0: none
  };
  struct View;  // data of one frame

  /// Updates a point from the frame; returns false if it is to be dropped.
  bool review(const View& view, float dt_s, Point& point);
  void add_points(const View& view);
  void cover(const View& view, LastingKind kind, float u_px, float v_px, float depth_m);
  /// Fills cells_ and cell_of_ from the points of a kind, and connects touching cells.
  void sort_into_cells(LastingKind kind, float seconds);
  [[nodiscard]] std::uint32_t find_cell(std::uint64_t code) const;
  std::uint32_t thing_of(std::uint32_t cell);
  void judge_things(LastingKind kind, std::vector<LastingChange>& changes);

  ChangeTrackerConfig config_;
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();  ///< first position of the camera
  bool has_origin_ = false;
  double last_stamp_s_ = 0.0;
  std::uint32_t next_id_ = 1;
  std::vector<Point> points_;          ///< sorted by id
  std::vector<std::uint8_t> covered_;  ///< per sampling grid point; bit 1 << kind: a point represents it
  std::vector<Cell> cells_;
  std::vector<Thing> things_;           ///< indexed by an object's root cell
  std::vector<std::uint32_t> cell_of_;  ///< per point; kNone for points of the other kind
  std::vector<std::uint32_t> table_;    ///< hash table of cells by code; kNone: empty slot
};

}  // namespace roomradar
