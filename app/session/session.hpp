// session.hpp: augmented reality in a saved room: turns each frame into a composed picture.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/physics/physics.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "app/render/compose.hpp"
#include "app/render/draw.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/frame_use.hpp"
#include "app/session/map_updater.hpp"
#include "app/session/script.hpp"
#include "mapping/localization/locator.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/surface/unknown_surface.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

struct SessionConfig {
  PoseOrigin poses = PoseOrigin::kTracked;
  FrameSceneConfig scene;
  RadarConfig radar;
  PhysicsConfig physics;
  ComposeConfig picture;
  std::optional<MapUpdateConfig> map_updates;  ///< none: the room stays as saved
  /// Settings that trade accuracy for time; users set them through RunQuality.
  int depth_stride = 1;           ///< 1, 2 or 4: factor by which depth images are reduced (reduce_depth)
  int tracking_px = 160;          ///< max width of the images used for localisation
  bool fine_mesh = false;         ///< near objects, the dynamic mesh has the image's full resolution
  int move_every_n_frames = 1;    ///< each object is moved every this many frames, objects in turns
  double object_error_px = 0.7;   ///< max deviation of an object's drawn mesh from the file's
  int shadow_every_n_frames = 1;  ///< frames between full recomputations of a shadow
  /// Frames between pictures. If > 1, objects move only in the frames without a picture.
  int picture_every_n_frames = 1;
  bool make_picture = true;  ///< false: no drawing; only the work that moves objects
  /// Called before each part of a frame, and with kDone after the last. A returned quality applies from that
  /// part on; with kDone it is ignored. Null: not called.
  std::function<std::optional<RunQuality>(FramePart, const FrameLoad&)> watch;
  /// After each frame the exact radar measures how deep objects overlap the room and each other, along
  /// gravity.
  bool measure_penetration = false;
};

enum class FrameStatus {
  kDone,
  kNotLocated,  ///< no camera pose: objects do not move, the picture shows no objects
  kBadFrame,    ///< images do not match their cameras: nothing changes, not even the picture
};

struct FrameResult {
  FrameStatus status = FrameStatus::kNotLocated;
  std::string_view fault;  ///< reason for kBadFrame, as from fault_of()
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< kDone only
  TrackStatus tracking = TrackStatus::kDiverged;
  ForegroundCounts foreground;
  std::size_t dynamic_triangles = 0;
  std::size_t static_triangles_drawn = 0;  ///< for the expected depth
  std::size_t inferred_triangles = 0;      ///< of the inferred backs of dynamic surfaces
  int contacts = 0;
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< contacts per kind of surface touched
  double deepest_penetration_m = 0.0;                 ///< >= 0; only if measured
  FrameUse use;                                       ///< kDone only
  bool picture_is_new = false;                        ///< false: picture() is that of an earlier frame
};

/// The state of a run from frame to frame. The saved map is only read. Not thread safe; GL calls are made on
/// the constructing thread.
class Session {
 public:
  /// `map` must outlive the session. Throws Error if GL is not available or a config is invalid.
  /// @param octree  the map's; required with config.adopt, and modified by it
  Session(const SavedMap& map, const SessionConfig& config, StaticMap* octree = nullptr);

  /// From now on objects cannot enter space that the map's scan has not observed. An object placed in such
  /// space can leave it. Stage timed: unknown. Throws Error unless the surfaces are the map's; also on a
  /// first call after a frame if config().adopt is set.
  void make_unknown_solid(StageTimes& times);

  /// From now on unknown space is free; all objects count as placed in observed space.
  void make_unknown_free();
  /// Takes effect in the next frame. Throws Error for surfaces other than the map's if config().adopt is set
  /// or unknown space is solid.
  void set_surfaces(SurfacePolicy surfaces);
  /// Takes effect in the next frame. Throws Error if the config is invalid.
  void set_radar(const RadarConfig& config);
  /// Takes effect at once; a depth stride in the next frame. Throws Error if the quality is invalid.
  void set_quality(const RunQuality& quality);

  /// Processes one frame, from sensor data to picture. Stages timed: reduce adopt locate expected foreground
  /// changes mesh place physics radar compose frame, and contact: from the frame's arrival until its contacts
  /// have moved the objects.
  FrameResult step(const Frame& frame, StageTimes& times);

  /// Adds an object that is not in the room at first. Throws Error if the name is taken or the mesh is
  /// unsuitable.
  void add_object(const std::string& name, const Mesh& mesh);
  /// Adds an object from parts that were prepared earlier, such as on another thread.
  void add_object(const std::string& name, ObjectParts parts);

  /// Executes an event before the frame in which it is due: adds, moves or removes an object, or changes a
  /// policy. A drop over "a surface in view" waits for a frame that shows one; the object's next event
  /// replaces a waiting drop. Turning an object that is not in the room does nothing. Throws Error and
  /// changes nothing if the event is impossible: unknown object, name taken, unreadable mesh, incompatible
  /// policies.
  void apply(const ScriptEvent& event);

  /// Makes this session's GL context current. Needed only if a thread has several sessions: before each is
  /// used or destroyed. Throws Error if the renderer refuses.
  void make_current() const { context_.make_current(); }
  [[nodiscard]] const std::string& renderer() const { return context_.renderer(); }
  [[nodiscard]] const std::vector<std::unique_ptr<VirtualObject>>& objects() const { return objects_; }
  [[nodiscard]] const ColourImage& picture() const { return picture_; }
  [[nodiscard]] const FrameScene& scene() const { return scene_; }
  /// Current shape, with all committed changes.
  [[nodiscard]] const Shape& room() const { return room_; }
  /// The config as given, updated by the set_ functions.
  [[nodiscard]] const SessionConfig& config() const { return config_; }
  [[nodiscard]] bool unknown_is_solid() const { return unknown_is_solid_; }
  /// A drop over a surface in view that has not found a surface.
  struct WaitingDrop {
    ScriptEvent drop;
    std::int64_t try_at_frame;  ///< earliest localised frame for the next search
  };
  [[nodiscard]] const std::vector<WaitingDrop>& waiting_drops() const { return waiting_; }
  /// Returns everything that an object can touch, without the object itself; null: with all objects.
  [[nodiscard]] std::vector<SceneTree> scene_without(const VirtualObject* object) const;
  /// Camera and pose of the picture; unset before the first localised frame with a picture.
  struct ShownView {
    Intrinsics camera;
    Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
  };
  [[nodiscard]] const std::optional<ShownView>& shown_view() const { return shown_view_; }
  /// Empty until unknown space is made solid.
  [[nodiscard]] const UnknownSurface& unknown() const { return unknown_; }
  /// Returns the changes committed to the room so far.
  [[nodiscard]] std::vector<CommittedChange> committed_changes() const;
  /// Waits for a running commit, so the octree may be read.
  void finish_commits();

 private:
  const SavedMap& map_;
  SessionConfig config_;
  GlContext context_;
  Shape room_;
  UnknownSurface unknown_;
  TriangleTree unknown_tree_;
  bool unknown_is_solid_ = false;
  FrameScene scene_;
  std::unique_ptr<MapUpdater> map_updater_;  ///< null: the room does not change
  Locator locator_;
  CyberRadar radar_;
  std::uint64_t asked_of_former_ = 0;  ///< static triangles examined by earlier radars
  ProximityQuery proximity_;
  std::vector<ClosestPoint> closest_points_;
  std::vector<SceneBody> others_;  // bodies in the scene of the object being moved
  CyberRadar exact_radar_;         ///< measures penetration
  ObjectDrawer drawer_;

  std::vector<std::unique_ptr<VirtualObject>> objects_;
  std::vector<FineRegion> fine_regions_;
  std::array<std::optional<RunQuality>, kFrameParts> due_quality_;  ///< per part of the next frame
  Frame reduced_;                                                   ///< copy of the frame with reduced depth
  double moved_fraction_ = 0.0;
  std::int64_t frames_ = 0;  ///< number of localised frames
  std::vector<WaitingDrop> waiting_;
  std::size_t last_shadow_ = 0;  ///< index of the object whose shadow was renewed last
  double last_stamp_s_ = 0.0;
  bool has_last_stamp_ = false;

  std::optional<Eigen::Isometry3d> T_world_before_;  ///< the previous frame's pose, if localised
  std::optional<ShownView> shown_view_;
  std::optional<ShownView> colour_view_;          ///< view of the last colour image, while that is recent
  static constexpr int kColourLasts_frames = 15;  ///< half a second of a Kinect's frames
  int frames_without_colour_ = kColourLasts_frames + 1;  ///< since the last colour image
  DepthImage real_depth_m_;  ///< as seen by the colour camera, in the rectangle around objects
  ObjectLayer layer_;
  Occlusion occlusion_;
  ColourImage background_;
  ColourImage picture_;

  void renew_room();
  FrameResult pass_through(const Frame& frame, StageTimes& times);
  /// Returns true if the object with this index is moved in this frame.
  [[nodiscard]] bool is_turn_to_move(std::size_t number) const;
  /// Begins a part of the frame: applies a quality that is due and calls config.watch.
  void begin(FramePart part);
  [[nodiscard]] FrameLoad load() const;
  /// Returns the frame, or reduced_ if the depth stride is not 1.
  const Frame& with_depth_reduced(const Frame& frame);
  /// Returns true if work done every `turns` frames is due in this frame; `number` staggers objects.
  [[nodiscard]] bool is_turn(std::size_t number, int turns) const {
    return (frames_ + static_cast<std::int64_t>(number)) % turns == 0;
  }
  [[nodiscard]] std::uint64_t static_triangles_tested() const {
    return asked_of_former_ + radar_.static_triangles_tested();
  }
  Tracking locate_camera(const Frame& frame);
  void turn(VirtualObject& object, const Eigen::Vector3d& turn_world_deg);
  /// Lifts an object that overlaps other objects on top of them, if the room leaves space there.
  void raise_over_others(VirtualObject& object);
  /// Sets fine_regions_: balls around the objects in which the dynamic mesh has full resolution.
  void find_fine_regions();
  /// Sets fine_cells of all objects.
  void count_fine_cells();
  /// Returns the counts of this frame. `drawn` and `asked` are the counters' values before the frame.
  FrameUse use_of(const ForegroundCounts& foreground, const FrameScene::RoomDrawn& drawn,
                  std::uint64_t asked);
  void release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Returns one entry per tree of scene_without(): the tree's body, or null if the tree is not an object.
  std::span<const SceneBody> bodies_in(const std::vector<SceneTree>& scene, const VirtualObject& object);
  void move_objects(double dt_s, StageTimes& times, FrameResult& result);
  [[nodiscard]] bool is_in_unknown(const VirtualObject& object) const;
  double penetration_m();
  /// Copies the frame's colour, if any, to background_, and sets colour_view_ to the camera's view when the
  /// colour was taken.
  void keep_colour(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s);
  /// Returns the view of background_: that of the last colour image. If there has been no colour for
  /// kColourLasts_frames, background_ becomes the shaded depth, in the depth camera's view.
  ShownView view_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Resets colour_view_ if there has been no colour for kColourLasts_frames: the last image is out of date.
  void watch_for_colour(const Frame& frame);
  /// Makes the picture of a frame that was not localised.
  void show_camera_alone(const Frame& frame);
  /// Renews the shadow of one object, the next in turn that has rotated since its last shadow or has come to
  /// rest. The shadow is coarse while the object moves, and full once at rest.
  void renew_a_shadow();
  void compose_picture(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  VirtualObject& object_named(const std::string& name);
  void require_new(const std::string& name) const;
  void change_objects(const ScriptEvent& event);
};

}  // namespace roomradar
