// change_tracker.hpp: which of what moved has come to stay, and which of what was there has gone for good.
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
  kCame,  ///< stands where the static model has nothing
  kWent,  ///< the static model has it, and the sensor sees through it
};
/// As the reports call it.
std::string_view to_string(LastingKind kind);

/// One thing that came, or went: points of its surface, about spacing_m apart.
struct LastingChange {
  LastingKind kind = LastingKind::kCame;
  std::vector<Eigen::Vector3d> points_world;
  std::vector<std::uint32_t> ids;  ///< of the points, ascending: the tracker knows them by these
  [[nodiscard]] Eigen::AlignedBox3d box_world() const;
};

/// "Sigmas" are of sensor noise at that depth and of the pose and model error, added as variances.
struct ChangeTrackerConfig {
  float spacing_m = 0.02F;          ///< between the points that stand for a surface
  float agree_sigmas = 2.5F;        ///< a surface within so many of where it was has not moved
  float pose_sigma_m = 0.003F;      ///< how far static things seem to be off from frame to frame
  float pose_sigma_per_m = 0.001F;  ///< and what grows with depth
  /// What comes nearer than a point by less than this is the point's own surface, moved; by more, it is
  /// something else before it, and nothing is known of the point meanwhile.
  float own_reach_m = 0.1F;
  float link_m = 0.03F;  ///< edge of the cells in which a thing hangs together, corner to corner
  int min_cells = 8;     ///< a thing of fewer cells is not worth a change
  /// A thing settles as a whole: so many of its cells must have a point that stayed. One that holds still at
  /// its middle while its rim moves, as a hand that sways, does not.
  float min_steady_fraction = 0.75F;
  /// Of what went, so many of its cells must lie in its middle, with cells all round. An edge of the map that
  /// stands a little off, by an error of poses, is seen through as well, in a strip one or two cells wide.
  float min_core_fraction = 0.15F;
  float min_seen_fraction = 0.5F;  ///< of its points, seen at their places in this frame
  float forget_after_s = 60.0F;    ///< not seen for so long, a point goes
  std::size_t max_points = 20000;  ///< of all things together; no point is added to so many
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ChangeTrackerConfig& config);

/// Points on what moved and on what was taken away, kept in the world from frame to frame. In every frame
/// each is looked up in the depth image: where its surface is seen where it was (or, of what went, is seen
/// through) its time grows; where it is not, the point goes after a few frames; where it is hidden or out of
/// sight, time stands still. So nothing depends on how the camera moves. Allocates nothing from the first
/// frame on, but for the changes it hands out. Not thread safe.
class ChangeTracker {
 public:
  explicit ChangeTracker(const ChangeTrackerConfig& config = {});

  /// One frame. Images of the camera's size; labels as mark_foreground gives them for this depth and this
  /// expected depth; stamp_s: of the frame, for how long points have been seen (a gap counts as 0.5 s at
  /// most).
  void update(const DepthImage& depth_m, const DepthImage& expected_depth_m, const LabelImage& labels,
              const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double stamp_s);

  /// Things that have been as they are for so long while they were seen, and are seen now. The same thing is
  /// found again in every call until it is forgotten, moves, or the expected depth agrees with it.
  [[nodiscard]] std::vector<LastingChange> settled(double seconds);

  /// Of a change's points, the part that is still as it was.
  [[nodiscard]] double still_true(const LastingChange& change) const;
  /// Of a change's points, the part that the last frame saw as they were.
  [[nodiscard]] double seen_now(const LastingChange& change) const;
  /// Drops a change's points.
  void forget(const LastingChange& change);

  [[nodiscard]] std::size_t point_count() const { return points_.size(); }

 private:
  struct Point {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to origin_world_
    float steady_s = 0.0F;                               ///< seen as it was for so long
    float unseen_s = 0.0F;                               ///< since it was seen last
    std::uint32_t id = 0;
    std::uint16_t sightings = 1;
    std::uint8_t doubt = 0;
    bool as_it_was = true;  ///< seen so by the last frame
    LastingKind kind = LastingKind::kCame;
  };
  struct Cell {
    std::uint64_t code = 0;
    std::uint32_t joined_to = 0;  ///< another cell of the same thing, or itself: a forest
    bool steady = false;          ///< one of its points has stayed for long enough
    std::uint8_t neighbours = 0;  ///< cells that touch it
  };
  struct Thing {
    int cells = 0, steady_cells = 0, core_cells = 0;
    std::size_t points = 0, seen_points = 0;
    std::size_t change = 0;  ///< 1 + its place among the changes found; 0: none
  };
  struct View;  // of one frame

  /// Whether the point stays.
  bool review(const View& view, float dt_s, Point& point);
  void add_points(const View& view);
  void cover(const View& view, LastingKind kind, float u_px, float v_px, float depth_m);
  /// Fills cells_ and cell_of_ from the points of a kind, and joins cells that touch.
  void sort_into_cells(LastingKind kind, float seconds);
  [[nodiscard]] std::uint32_t find_cell(std::uint64_t code) const;
  std::uint32_t thing_of(std::uint32_t cell);
  void judge_things(LastingKind kind, std::vector<LastingChange>& changes);

  ChangeTrackerConfig config_;
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();  ///< where the camera was at first
  bool has_origin_ = false;
  double last_stamp_s_ = 0.0;
  std::uint32_t next_id_ = 1;
  std::vector<Point> points_;  ///< by id
  std::vector<std::uint8_t>
      covered_;  ///< by place of the sampling grid, bit 1 << kind: a point stands for it
  std::vector<Cell> cells_;
  std::vector<Thing> things_;           ///< by the cell that all of a thing's are joined to
  std::vector<std::uint32_t> cell_of_;  ///< by point; of those of the other kind: kNone
  std::vector<std::uint32_t> table_;    ///< cells by the hash of their code, kNone between
};

}  // namespace roomradar
