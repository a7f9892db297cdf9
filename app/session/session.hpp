// session.hpp: augmented reality in a saved room: composes a picture with virtual objects from each frame.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/session/apply_quality.hpp"
#include "app/session/frame_result.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/map_updater.hpp"
#include "app/session/object_set.hpp"
#include "app/session/picture_composer.hpp"
#include "app/session/session_config.hpp"
#include "app/session/session_room.hpp"
#include "app/session/tiles/building_tracker.hpp"
#include "mapping/localization/locator.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// State of an AR run. The map on disk is not modified; committed changes alter the octree that is passed.
/// Not thread safe: call all functions on the constructing thread, whose GL context is used. Objects,
/// policies and quality may be changed between frames. A function that throws Error changes nothing, except
/// that PlaceRefused cancels a waiting drop and ends carrying, and that finish_commits() may leave the octree
/// changed in part.
class Session {
 public:
  /// `map` must outlive the session. Throws Error if GL is not available, or a config or the map is invalid.
  /// @param octree  the map's octree; required with config.map_updates, which modify it
  Session(const SavedMap& map, const SessionConfig& config, StaticMap* octree = nullptr);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Processes one frame, from sensor data to picture. Stages timed: reduce commit tiles locate expected
  /// foreground changes mesh place physics radar light compose frame. Stage contact is the time from the call
  /// until all objects have been advanced.
  FrameResult step(const Frame& frame, StageTimes& times);

  /// Adds an object, outside the room until placed. Throws Error if the name is taken or the mesh is invalid.
  void add_object(const std::string& name, const Mesh& mesh) { objects_.add(name, Model{.mesh = mesh}); }
  /// Adds an object of a model file's content. Model::notes become notices.
  void add_object(const std::string& name, Model model, const BodyMaterial& material = {}) {
    objects_.add(name, std::move(model), material);
  }
  /// Adds an object from the result of object_parts(), which can be computed on another thread.
  void add_object(const std::string& name, ObjectParts parts, const BodyMaterial& material = {}) {
    objects_.add(name, std::move(parts), material);
  }
  /// Changes an object's mass, density, friction or restitution; see ObjectSet::set_material().
  void set_material(const std::string& name, const BodyMaterial& change) {
    objects_.set_material(name, change);
  }
  /// Puts an object into the room; see ObjectSet::place(). All functions that take the name of an object
  /// throw Error if there is none of that name.
  void place(const std::string& name, const ObjectState& state) { objects_.place(name, state); }
  /// Puts an object exactly into a pose, at rest; see ObjectSet::stand().
  void stand(const std::string& name, const Eigen::Isometry3d& T_world_object) {
    objects_.stand(name, T_world_object);
  }
  /// Puts an object into the room with the velocities of `state`.
  void throw_object(const std::string& name, const ObjectState& state) { objects_.place(name, state); }
  /// Drops an object from above a position, or from above a level surface in view. Without a position, the
  /// drop waits for a frame that shows such a surface; place(), drop(), carry(), release() and remove() of
  /// the object cancel it. Without a position, throws Error if the object's footprint radius is above
  /// kMostFootprint_m.
  void drop(const DropRequest& drop) { objects_.drop(drop, frames_); }
  /// Moves an object towards a position and holds it there until release(); see ObjectSet::carry().
  void carry(const std::string& name, const Eigen::Vector3d& position_world) {
    objects_.carry(name, position_world);
  }
  /// Lets go of a carried object with a velocity.
  void release(const std::string& name, const Eigen::Vector3d& velocity_world_mps) {
    objects_.release(name, velocity_world_mps);
  }
  /// Rotates an object in the room about the centre of its bounding box until the first contact.
  /// turn_world_deg is a rotation vector in world axes.
  void turn(const std::string& name, const Eigen::Vector3d& turn_world_deg) {
    objects_.turn(name, turn_world_deg);
  }
  /// Takes an object out of the room; its name stays in use.
  void remove(const std::string& name) { objects_.remove(name); }

  /// From now on, objects cannot enter space that the map's scan has not observed. Objects that are in
  /// unobserved space can leave it. Stage timed: unknown. Throws Error unless the surface policy is kMap.
  /// With config().map_updates, throws Error if the first call comes after the first frame. With
  /// config().tiles, throws Error if these lack unknown space.
  void make_unknown_solid(StageTimes& times);
  /// From now on, objects can enter unknown space.
  void make_unknown_free();
  /// Takes effect in the next frame. With policies other than kMap, unknown space is free. Throws Error for
  /// policies other than kMap if config().map_updates is set.
  void set_surfaces(SurfacePolicy surfaces);
  /// Takes effect in the next frame. Throws Error if the config is invalid.
  void set_radar(const RadarConfig& config);
  /// Takes effect at once, depth_stride in the next frame. Throws Error if the quality is invalid.
  void set_quality(const RunQuality& quality);
  /// Takes effect in the next frame at stage `part`, or at that frame's end if it has no such stage. Throws
  /// Error if the quality is invalid.
  void set_quality_from(FramePart part, const RunQuality& quality);
  /// Commits changes in view, see MapUpdater::ask(). Throws Error unless config().map_updates is set.
  void commit_changes();
  /// Returns the notices created since the last frame or call. The next FrameResult::notices then omits them.
  std::vector<ObjectNotice> take_notices() { return objects_.take_notices(); }
  [[nodiscard]] std::vector<CommittedChange> committed_changes() const;
  [[nodiscard]] const BuildingTracker* building() const { return building_.get(); }  ///< null: a room
  /// Waits for a running commit. Afterwards the octree may be read. Throws as MapUpdater::finish() does.
  void finish_commits() {
    if (map_updater_) map_updater_->finish();
  }

  /// Makes this session's GL context current. If a thread has several sessions, call this before using or
  /// destroying one of them. Throws Error if GL fails.
  void make_current() const { context_.make_current(); }
  [[nodiscard]] const std::string& renderer() const { return context_.renderer(); }
  [[nodiscard]] const std::vector<std::unique_ptr<VirtualObject>>& objects() const { return objects_.all(); }
  [[nodiscard]] const std::vector<WaitingDrop>& waiting_drops() const { return objects_.waiting_drops(); }
  /// Returns the frame's surfaces and the objects in the room, without `object` (may be null).
  [[nodiscard]] std::vector<SceneTree> scene_without(const VirtualObject* object) const {
    return objects_.scene_without(object);
  }
  [[nodiscard]] const ColourImage& picture() const { return composer_.picture(); }
  /// Camera and pose of the picture. Unset before the first localised frame with a picture, and after a frame
  /// that is not localised.
  [[nodiscard]] const std::optional<ShownView>& shown_view() const { return composer_.shown_view(); }
  [[nodiscard]] const FrameScene& scene() const { return scene_; }
  /// The room's current mesh with all committed changes: the shape that is drawn and touched, and the mesh
  /// with colours.
  [[nodiscard]] const Shape& room() const { return room_.shape; }
  [[nodiscard]] const Mesh& room_mesh() const { return map_updater_ ? map_updater_->room().mesh : map_.mesh; }
  /// Longest side of the bounding box of surface and observed space at the session's start, m.
  [[nodiscard]] double room_extent_m() const { return room_.extent_m; }
  /// Frontier of unknown space. Null until unknown space is made solid for the first time.
  [[nodiscard]] const UnknownSurface* unknown() const { return room_.unknown.get(); }
  [[nodiscard]] bool unknown_is_solid() const { return room_.unknown_is_solid; }
  /// The config given to the constructor, with all changes by the set_ functions.
  [[nodiscard]] const SessionConfig& config() const { return config_; }

 private:
  const SavedMap& map_;
  SessionConfig config_;
  RoomPreparation preparation_;  ///< started before GL opens; used up by the constructor
  GlContext context_;
  std::unique_ptr<BuildingTracker> building_;  ///< null unless config.tiles is set
  SessionRoom room_;
  FrameScene scene_;
  std::unique_ptr<MapUpdater> map_updater_;  ///< null unless config.map_updates is set
  Locator locator_;
  ObjectSet objects_;
  PictureComposer composer_;
  QualitySchedule schedule_;
  Frame reduced_;  ///< buffer: copy of the frame with reduced depth
  double moved_fraction_ = 0.0;
  std::int64_t frames_ = 0;  ///< number of localised frames
  std::optional<double> last_stamp_s_;

  FrameResult pass_through(const Frame& frame,
                           StageTimes& times);  ///< one function, to show the order of the steps
  /// Returns the time since the previous frame, s, >= 0; 0 for the first frame. Stores stamp_s.
  double seconds_since_last(double stamp_s);
  /// Begins a processing stage of the frame: applies the quality scheduled for it, and calls config.watch.
  void begin(FramePart part);
  /// Returns true in every n-th localised frame.
  [[nodiscard]] bool is_due_every(int n_frames) const { return frames_ % n_frames == 0; }
  /// Returns `frame`, or reduced_ if the depth stride is not 1.
  const Frame& with_depth_reduced(const Frame& frame);
  /// Replaces the room by the map updater's room().
  void renew_room();
  Tracking locate_camera(const Frame& frame);
  /// Completes a frame that was not localised.
  FrameResult pass_unlocated(const Frame& frame, TrackStatus tracking);
};

}  // namespace roomradar
