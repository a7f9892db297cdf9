// map_updater.hpp: fuses lasting changes of the room, such as a moved chair, into a session's copy of the
// map.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "app/session/session_config.hpp"
#include "dynamic/foreground/change_tracker.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/revision/refuse_region.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// A change that was fused into the room.
struct CommittedChange {
  LastingKind kind = LastingKind::kCame;
  double stamp_s = 0.0;           ///< timestamp of the first frame that used the changed room
  std::int64_t frame = 0;         ///< index of that frame
  Eigen::AlignedBox3d box_world;  ///< bounds of the change's observed points
};

/// The room with all changes committed so far. `tree` and `unknown_tree` are the radar's trees of `mesh` and
/// `unknown`.
struct ChangedRoom {
  Mesh mesh;
  TriangleTree tree;
  UnknownSurface unknown;  ///< frontier of unknown space; empty unless keep_up_unknown() was called
  TriangleTree unknown_tree;
};

/// Watches the dynamic foreground of a session's frames for lasting changes. A change that has not moved for
/// after_s is measured from the depth of `views` further frames. A worker thread then commits the change: it
/// fuses these frames into the octree and re-extracts the surface near the change. Until the worker is done,
/// frames use the old room. Changes that become due in the same frame are committed together. Later changes
/// wait until that commit is done. Not thread safe: make all calls from one thread.
class MapUpdater {
 public:
  /// @param octree  the room's octree; the worker thread modifies it in place during a commit
  /// @param mesh    the room's surface mesh, in the world
  /// Throws Error if the octree holds no surface or a config is invalid.
  MapUpdater(StaticMap& octree, const Mesh& mesh, const MapUpdateConfig& config);
  ~MapUpdater();
  MapUpdater(const MapUpdater&) = delete;
  MapUpdater& operator=(const MapUpdater&) = delete;

  /// Requests a commit of the changes in view. Changes are added objects that are stationary, and removed
  /// objects. The request expires after 1 s of frame time.
  void ask() { asked_until_s_ = kNow; }

  /// From now on, each commit also re-extracts the frontier of unknown space.
  void keep_up_unknown() { keeps_up_unknown_ = true; }

  /// Call before each frame. Returns true if a commit takes effect in this frame; callers must then use the
  /// new room(). Throws as finish() does.
  bool is_due(const Frame& frame);
  [[nodiscard]] ChangedRoom& room() { return room_; }
  /// Call after a frame's pixels have been labelled. Ignores a frame with the previous frame's index, since
  /// in a repeated frame all objects appear to be stationary.
  void watch(const Frame& frame, const DepthImage& expected_depth_m, const LabelImage& labels,
             const Eigen::Isometry3d& T_world_camera);

  /// Returns the changes committed so far, in order of time.
  [[nodiscard]] const std::vector<CommittedChange>& committed_changes() const { return committed_; }
  /// Waits for a running commit and applies it. The octree may be read afterwards, and the next is_due()
  /// returns true. Rethrows an exception of the worker thread. Each later call of finish() then throws Error,
  /// because the octree is only partly updated.
  void finish();

 private:
  static constexpr double kNow = -1.0;

  struct FrameClock {
    double stamp_s = 0.0;    ///< time of the current frame
    std::int64_t frame = 0;  ///< index of the current frame
    std::optional<std::int64_t> watched_frame;
    double next_look_s = 0.0;
  };
  struct Measurement {
    std::vector<LastingChange> pending;  ///< changes that are being measured or committed
    /// The first view_count entries are valid; the others are reusable buffers.
    std::vector<RegionView> views;
    int view_count = 0;
    /// During measurement: frames until it is abandoned. During a commit: frames until the changed room is
    /// due.
    int frames_left = 0;
  };

  StaticMap& octree_;
  MapUpdateConfig config_;
  ChangeTracker tracker_;
  std::vector<CommittedChange> committed_;
  /// Time at which ask()'s request expires. kNow: to be set in the next frame.
  std::optional<double> asked_until_s_;
  bool keeps_up_unknown_ = false;
  FrameClock clock_;
  Measurement measured_;
  std::future<ChangedRoom> working_;
  bool has_failed_ = false;
  bool is_room_new_ = false;  ///< the changed room has not been returned by is_due()
  ChangedRoom room_;          ///< current room

  void look_for_changes(double stamp_s);
  void measure(const Frame& frame, const DepthImage& expected_depth_m,
               const Eigen::Isometry3d& T_world_camera);
  [[nodiscard]] ChangedRoom work_in() const;
};

}  // namespace roomradar
