// map_updater.hpp: commits lasting changes of the room (objects added or removed) to a session's copy of the
// map.
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
  /// Commits a change after it was observed unchanged for this long. Unset: only on request.
  std::optional<double> after_s;
  double asked_after_s = 0.5;  ///< the same after ask(); long enough to exclude objects in motion
  int views = 12;              ///< number of frames from which a detected change is measured
  /// The changed room takes effect this many frames after its last view, never earlier.
  int apply_after_frames = 15;
  /// true: the frame in which the changed room is due waits for the worker thread, so results are
  /// reproducible. false: no frame waits; the room takes effect in the first frame after it is ready.
  bool wait = true;
  ChangeTrackerConfig tracker;
  SurfaceConfig surface;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const MapUpdateConfig& config);

/// A change that was committed to the room.
struct CommittedChange {
  LastingKind kind = LastingKind::kCame;
  double stamp_s = 0.0;           ///< time of the first frame that used the changed room
  std::int64_t frame = 0;         ///< index of that frame
  Eigen::AlignedBox3d box_world;  ///< bounds of the observed part of its surface
};

/// The room with all changes committed so far. `tree` (of `mesh`) and `unknown_tree` are for the radar.
struct ChangedRoom {
  Mesh mesh;
  TriangleTree tree;
  UnknownSurface unknown;  ///< empty unless keep_up_unknown() was called
  TriangleTree unknown_tree;
};

/// Watches the dynamic foreground of a session's frames for lasting changes. A change that was unchanged for
/// long enough (settled) is measured from a few more frames. A worker thread then fuses it into the octree
/// and extracts the surface near it again; frames see the old room until then. Handles one change, or several
/// that settled together, at a time. Not thread safe: make all calls from one thread.
class MapUpdater {
 public:
  /// @param octree  the room's octree; modified in place, by the worker thread during a commit
  /// @param mesh    the room's surface, in the world
  /// Throws Error if the octree holds no surface or a config is invalid.
  MapUpdater(StaticMap& octree, const Mesh& mesh, const MapUpdateConfig& config);
  ~MapUpdater();
  MapUpdater(const MapUpdater&) = delete;
  MapUpdater& operator=(const MapUpdater&) = delete;

  /// Requests a commit of the objects in view that came and stand still, or that are gone. The request
  /// expires after 1 s of frame time.
  void ask() { asked_until_s_ = kNow; }

  /// From now on each commit also extracts the border of unknown space again.
  void keep_up_unknown() { keeps_up_unknown_ = true; }

  /// Call before each frame. Returns true if the room has changed; callers must then use the new room().
  bool is_due(const Frame& frame);
  [[nodiscard]] ChangedRoom& room() { return room_; }
  /// Call after a frame's pixels are labelled. Ignores a frame with the previous frame's index, since in a
  /// repeated frame everything seems to stand still.
  void watch(const Frame& frame, const DepthImage& expected_depth_m, const LabelImage& labels,
             const Eigen::Isometry3d& T_world_camera);

  /// Returns the changes committed so far, in order of time.
  [[nodiscard]] const std::vector<CommittedChange>& committed_changes() const { return committed_; }
  /// Waits for a running commit and applies it as if it were due; the octree may be read afterwards. Rethrows
  /// the commit's exception. After such a failure every call throws Error, because the octree is half
  /// changed.
  void finish();

 private:
  static constexpr double kNow = -1.0;

  struct FrameClock {
    double stamp_s = 0.0;    ///< time of the current frame
    std::int64_t frame = 0;  ///< its index
    std::optional<std::int64_t> watched_frame;
    double next_look_s = 0.0;
  };
  struct Measurement {
    std::vector<LastingChange> pending;  ///< settled changes that are being measured or committed
    std::vector<RegionView> views;       ///< the first view_count are in use; the others are buffers to reuse
    int view_count = 0;
    int frames_left = 0;  ///< frames until measuring is given up, or until the changed room is due
  };

  StaticMap& octree_;
  MapUpdateConfig config_;
  ChangeTracker tracker_;
  std::vector<CommittedChange> committed_;
  std::optional<double> asked_until_s_;  ///< time at which ask()'s request expires; kNow: set at next frame
  bool keeps_up_unknown_ = false;
  FrameClock clock_;
  Measurement measured_;
  std::future<ChangedRoom> working_;
  bool has_failed_ = false;
  ChangedRoom room_;  ///< current room

  void look_for_changes(double stamp_s);
  void measure(const Frame& frame, const DepthImage& expected_depth_m,
               const Eigen::Isometry3d& T_world_camera);
  [[nodiscard]] ChangedRoom work_in() const;
};

}  // namespace roomradar
