// session.hpp: augmented reality in a saved room: one frame in, one composed picture out.
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
  std::optional<MapUpdateConfig> map_updates;  ///< none: the room stays as it was saved
  /// What can be traded for time; RunQuality says it for the user.
  int depth_stride = 1;           ///< 1, 2 or 4: depth images are reduced by this (reduce_depth)
  int tracking_px = 160;          ///< widest image that the camera is located by
  bool fine_mesh = false;         ///< what moved is meshed as finely as it was seen about the objects
  int move_every_n_frames = 1;    ///< objects are moved in every so many-th frame, in turns
  double object_error_px = 0.7;   ///< how far an object's drawn mesh may lie off the file's
  int shadow_every_n_frames = 1;  ///< frames from one shadow made anew in full to the next
  int picture_every_n_frames =
      1;                     ///< frames from one picture to the next; more than 1: objects move in the others
  bool make_picture = true;  ///< false: no drawing, only what moves the objects
  /// Called before each part of a frame, and after it; what it returns is the quality from that part on.
  /// Null: nobody asks.
  std::function<std::optional<RunQuality>(FramePart, const FrameLoad&)> watch;
  /// The exact radar looks after each frame how deep objects stand, along gravity, in the room and in one
  /// another.
  bool measure_penetration = false;
};

enum class FrameStatus {
  kDone,
  kNotLocated,  ///< the camera was not found in the room: objects hold still, the picture is the camera's own
  kBadFrame,    ///< its images do not fit its cameras: nothing changes, the picture neither
};

struct FrameResult {
  FrameStatus status = FrameStatus::kNotLocated;
  std::string_view fault;  ///< of a bad frame, as fault_of() says it
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< only if done
  TrackStatus tracking = TrackStatus::kDiverged;
  ForegroundCounts foreground;
  std::size_t dynamic_triangles = 0;
  std::size_t static_triangles_drawn = 0;  ///< for the expected depth
  std::size_t inferred_triangles = 0;      ///< of the backs of what moved
  int contacts = 0;
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< the same, by what was touched
  double deepest_penetration_m = 0.0;                 ///< >= 0, where it is measured
  FrameUse use;                                       ///< only if done
  bool picture_is_new = false;  ///< else picture() is what it was after an earlier frame
};

/// Everything a run keeps from frame to frame. The saved map is only read. Not thread safe; GL on the thread
/// that made it.
class Session {
 public:
  /// `map` must outlive the session. Throws Error if there is no GL, or a config is out of its rules.
  /// @param octree  the map's; needed with config.adopt, and then changed with the room
  Session(const SavedMap& map, const SessionConfig& config, StaticMap* octree = nullptr);

  /// From now on objects do not enter space that the map's scan has not seen. One that is put into such space
  /// can leave it. Stage timed: unknown. Throws Error unless the surfaces are the map's.
  void make_unknown_solid(StageTimes& times);

  /// From now on it is free; all objects count as having begun in seen space.
  void make_unknown_free();
  /// From the next frame on. Throws Error if changes are adopted or unknown space is solid, and the surfaces
  /// are not the map's.
  void set_surfaces(SurfacePolicy surfaces);
  /// From the next frame on. Throws Error if the config is out of its rules.
  void set_radar(const RadarConfig& config);
  /// From now on; a depth stride from the next frame on. Throws Error if it is out of its rules.
  void set_quality(const RunQuality& quality);

  /// One frame, from sensor to picture. Stages timed: locate expected foreground changes mesh radar physics
  /// compose frame, and contact: from the frame handed over to where its contacts have moved the objects.
  FrameResult step(const Frame& frame, StageTimes& times);

  /// Adds an object that is not in the room yet. Throws Error if another has that name, or the mesh cannot be
  /// an object.
  void add_object(const std::string& name, const Mesh& mesh);
  /// The same of parts that were made ahead, beside the frames.
  void add_object(const std::string& name, ObjectParts parts);

  /// Adds, places, drops, throws, turns, carries or removes an object, or changes a policy, before the frame
  /// it is due in. A drop over "a surface in view" that has none waits for a frame that shows one, or for the
  /// object's next event, which replaces it; what is not in the room is not turned. Throws Error where that
  /// cannot be, and changes nothing: no such object, two of one name, a mesh that cannot be read, a policy
  /// that does not go with another.
  void apply(const ScriptEvent& event);

  /// Where a thread has several sessions: before another one is used, or ends. Throws Error if the renderer
  /// refuses.
  void make_current() const { context_.make_current(); }
  [[nodiscard]] const std::string& renderer() const { return context_.renderer(); }
  [[nodiscard]] const std::vector<std::unique_ptr<VirtualObject>>& objects() const { return objects_; }
  [[nodiscard]] const ColourImage& picture() const { return picture_; }
  [[nodiscard]] const FrameScene& scene() const { return scene_; }
  /// As it is by now.
  [[nodiscard]] const Shape& room() const { return room_; }
  /// As it was given, but for the policies that were changed since.
  [[nodiscard]] const SessionConfig& config() const { return config_; }
  [[nodiscard]] bool unknown_is_solid() const { return unknown_is_solid_; }
  /// A drop over a surface in view that has found none yet.
  struct WaitingDrop {
    ScriptEvent drop;
    std::int64_t try_at_frame;  ///< of those that were located
  };
  [[nodiscard]] const std::vector<WaitingDrop>& waiting_drops() const { return waiting_; }
  /// All that an object can touch, without itself; null: with every object in the room.
  [[nodiscard]] std::vector<SceneTree> scene_without(const VirtualObject* object) const;
  /// The camera that the picture was taken with, and its pose; nothing before the first frame that was
  /// located and had a picture made.
  struct ShownView {
    Intrinsics camera;
    Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
  };
  [[nodiscard]] const std::optional<ShownView>& shown_view() const { return shown_view_; }
  /// Without triangles unless it was made solid.
  [[nodiscard]] const UnknownSurface& unknown() const { return unknown_; }
  /// What came and stayed, or was taken away, and is part of the room by now.
  [[nodiscard]] std::vector<CommittedChange> committed_changes() const;
  /// Waits for what is being worked into the octree, so that it may be read.
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
  std::unique_ptr<MapUpdater> map_updater_;  ///< null: the room stays as it is
  Locator locator_;
  CyberRadar radar_;
  std::uint64_t asked_of_former_ = 0;  ///< of the room's triangles, by radars before this one
  ProximityQuery proximity_;
  std::vector<ClosestPoint> closest_points_;
  std::vector<SceneBody> others_;  // of the scene of the object that is moved
  CyberRadar exact_radar_;         ///< measures penetration
  ObjectDrawer drawer_;

  std::vector<std::unique_ptr<VirtualObject>> objects_;
  std::vector<FineRegion> fine_regions_;
  std::array<std::optional<RunQuality>, kFrameParts> due_quality_;  ///< of the next frame's parts
  Frame reduced_;                                                   ///< the frame, where its depth is reduced
  double moved_fraction_ = 0.0;
  std::int64_t frames_ = 0;           ///< that were located
  std::vector<WaitingDrop> waiting_;  ///< waiting_drops()
  std::size_t last_shadow_ = 0;       ///< number of the object whose shadow was made last
  double last_stamp_s_ = 0.0;
  bool has_last_stamp_ = false;

  std::optional<Eigen::Isometry3d> T_world_before_;  ///< of the frame before, if it was located
  std::optional<ShownView> shown_view_;
  std::optional<ShownView> colour_view_;                 ///< of the last colour, while it lasts
  static constexpr int kColourLasts_frames = 15;         ///< half a second of a Kinect's
  int frames_without_colour_ = kColourLasts_frames + 1;  ///< since the last that had any
  DepthImage real_depth_m_;                              ///< as the colour camera sees it, where objects are
  ObjectLayer layer_;
  Occlusion occlusion_;
  ColourImage background_;
  ColourImage picture_;

  void renew_room();
  FrameResult pass_through(const Frame& frame, StageTimes& times);
  /// Of the objects in the room, whether this one is moved in this frame.
  [[nodiscard]] bool is_turn_to_move(std::size_t number) const;
  /// A part of the frame begins: what is due in it, and what is watched for.
  void begin(FramePart part);
  [[nodiscard]] FrameLoad load() const;
  /// The frame, with its depth reduced if that is wanted.
  const Frame& with_depth_reduced(const Frame& frame);
  /// Whether that which is done in every so many-th frame is due in this one; `number` tells apart those that
  /// share the turns.
  [[nodiscard]] bool is_turn(std::size_t number, int turns) const {
    return (frames_ + static_cast<std::int64_t>(number)) % turns == 0;
  }
  [[nodiscard]] std::uint64_t static_triangles_tested() const {
    return asked_of_former_ + radar_.static_triangles_tested();
  }
  Tracking locate_camera(const Frame& frame);
  void turn(VirtualObject& object, const Eigen::Vector3d& turn_world_deg);
  /// Puts what would begin inside other objects on top of them, where the room leaves space for it there.
  void raise_over_others(VirtualObject& object);
  /// Balls about the objects, in which what moved is meshed as finely as it was seen.
  void find_fine_regions();
  /// Sets fine_cells of all objects.
  void count_fine_cells();
  /// What the frame needed, where nothing was drawn and asked before `drawn` and `asked`.
  FrameUse use_of(const ForegroundCounts& foreground, const FrameScene::RoomDrawn& drawn,
                  std::uint64_t asked);
  void release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Which of the trees of scene_without() are bodies.
  std::span<const SceneBody> bodies_in(const std::vector<SceneTree>& scene, const VirtualObject& object);
  void move_objects(double dt_s, StageTimes& times, FrameResult& result);
  [[nodiscard]] bool is_in_unknown(const VirtualObject& object) const;
  double penetration_m();
  /// The frame's colour, if it has any, into background_, and from where the camera was when that was taken
  /// into colour_view_.
  void keep_colour(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s);
  /// Which camera saw background_ from where: the last colour there was; where there is none for longer than
  /// a few frames, the depth, shaded, as the depth camera sees it.
  ShownView view_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Where the colour has stopped, its last picture does not stand for what is there now.
  void watch_for_colour(const Frame& frame);
  /// The picture of a frame whose place is not known.
  void show_camera_alone(const Frame& frame);
  /// Makes one shadow anew, of the next object that has turned since its own was made, or has come to rest:
  /// coarsely, and once it rests in full.
  void renew_a_shadow();
  void compose_picture(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  VirtualObject& object_named(const std::string& name);
  void require_new(const std::string& name) const;
  void change_objects(const ScriptEvent& event);
};

}  // namespace roomradar
