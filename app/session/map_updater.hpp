// map_updater.hpp: what came and stays, and what was taken away, worked into a session's own copy of the
// room.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "dynamic/foreground/change_tracker.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/revision/refuse_region.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/surface/unknown_surface.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

struct MapUpdateConfig {
  /// What has been as it is for so long while it was seen is adopted. None: only what is asked for.
  std::optional<double> after_s;
  double asked_after_s = 0.5;  ///< the same for what is asked for: at once, but for what is on its way
  int views = 12;              ///< frames that a change is measured from, after it was found
  /// The changed room is there so many frames after its last view, and not before.
  int apply_after_frames = 15;
  /// A frame that is due waits for a room that is late, so that a recording gives the same answer each time.
  /// false: the room is taken when it is ready, and no frame waits.
  bool wait = true;
  ChangeTrackerConfig tracker;
  SurfaceConfig surface;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const MapUpdateConfig& config);

/// A change that was worked into the room.
struct CommittedChange {
  LastingKind kind = LastingKind::kCame;
  double stamp_s = 0.0;           ///< of the frame that saw the changed room first
  std::int64_t frame = 0;         ///< its index
  Eigen::AlignedBox3d box_world;  ///< of its surface, as far as it was seen
};

/// The room as it is by now, for the radar; its triangles are those of `mesh`.
struct ChangedRoom {
  Mesh mesh;
  TriangleTree tree;
  UnknownSurface unknown;  ///< only if it is kept up
  TriangleTree unknown_tree;
};

/// Watches what moved in the frames of a session. A change that has settled is measured from a few frames
/// more and worked into the octree by a second thread, with the surface near it made anew; the frames
/// meanwhile see the room as it was. One change, or several that settled together, at a time. Not thread
/// safe: all calls from one thread.
class MapUpdater {
 public:
  /// @param octree  of the room; changed in place, by the second thread while is_working()
  /// @param mesh    its surface, in the world
  /// Throws Error if the octree holds no surface, or a config is out of its rules.
  MapUpdater(StaticMap& octree, const Mesh& mesh, const MapUpdateConfig& config);
  ~MapUpdater();
  MapUpdater(const MapUpdater&) = delete;
  MapUpdater& operator=(const MapUpdater&) = delete;

  /// Adopts what stands still now, or has gone, in view: within a second or not at all.
  void ask() { asked_until_s_ = kNow; }

  /// From now on the border of the unknown is made anew with the room.
  void keep_up_unknown() { keeps_up_unknown_ = true; }

  /// Before a frame: whether the room has changed. Then the trees are to be taken from room().
  bool is_due(const Frame& frame);
  [[nodiscard]] ChangedRoom& room() { return room_; }
  /// After a frame's foreground is known. A frame that is shown again, by its index, tells nothing new: what
  /// moves stands still in it.
  void watch(const Frame& frame, const DepthImage& expected_depth_m, const LabelImage& labels,
             const Eigen::Isometry3d& T_world_camera);

  /// What was worked in so far, in the order of time.
  [[nodiscard]] const std::vector<CommittedChange>& committed_changes() const { return committed_; }
  /// Waits for a change that is being worked in, and takes it as if it were due: then the octree may be read.
  /// Throws what went wrong while it was worked in, and Error from then on: the octree is half changed.
  void finish();

 private:
  static constexpr double kNow = -1.0;

  StaticMap& octree_;
  MapUpdateConfig config_;
  ChangeTracker tracker_;
  std::vector<CommittedChange> committed_;
  std::optional<double> asked_until_s_;  ///< kNow: from the next frame on
  bool keeps_up_unknown_ = false;
  double stamp_s_ = 0.0;  ///< of the frame now
  std::int64_t frame_ = 0;
  std::optional<std::int64_t> watched_frame_;
  double next_look_s_ = 0.0;
  std::vector<LastingChange> pending_;  ///< settled, being measured or worked in
  std::vector<RegionView> views_;       ///< of them; filled up to view_count_, kept for the next ones
  int view_count_ = 0;
  int frames_left_ = 0;  ///< to the end of measuring, or to when the room is due
  std::future<ChangedRoom> working_;
  bool has_failed_ = false;
  ChangedRoom room_;  ///< of the frames now

  void look_for_changes(double stamp_s);
  void measure(const Frame& frame, const DepthImage& expected_depth_m,
               const Eigen::Isometry3d& T_world_camera);
  [[nodiscard]] ChangedRoom work_in() const;
};

}  // namespace roomradar
