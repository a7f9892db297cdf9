// session_config.hpp: settings of a session.
#pragma once
#include <functional>
#include <optional>

#include "app/physics/physics_config.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "app/render/compose.hpp"
#include "app/session/tiles/tile_choice.hpp"
#include "dynamic/foreground/change_tracker.hpp"
#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/surface/depth_mesh.hpp"
#include "dynamic/surface/dynamic_surface.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/pose_origin.hpp"
#include "radar/exact/radar_query.hpp"

namespace roomradar {

/// Settings of FrameScene.
struct FrameSceneConfig {
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  ForegroundConfig foreground = {};
  DynamicSurfaceConfig moved = {};  ///< used with SurfacePolicy::kMap
  DepthMeshConfig mesh = {};        ///< used with the other policies
};

/// Settings of MapUpdater.
struct MapUpdateConfig {
  /// Time without motion after which a change is committed to the map, s. Unset: changes are committed only
  /// after ask().
  std::optional<double> after_s;
  /// after_s for changes requested by ask(), s. Long enough that objects in motion are not committed.
  double asked_after_s = 0.5;
  int views = 12;  ///< number of frames whose depth is fused to measure a change
  /// Frames between the last measured frame and the first frame that uses the changed room.
  int apply_after_frames = 15;
  /// true: the frame in which the changed room is due waits for the worker thread. Results are then
  /// reproducible. false: frames do not wait. The changed room may then take effect later.
  bool wait = true;
  ChangeTrackerConfig tracker;
  SurfaceConfig surface;
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const MapUpdateConfig& config);

struct SessionConfig {
  PoseOrigin poses = PoseOrigin::kAuto;
  FrameSceneConfig scene;
  RadarConfig radar;
  PhysicsConfig physics;
  ComposeConfig picture;
  std::optional<MapUpdateConfig> map_updates;  ///< unset: the room does not change during the session
  /// Tiles of a building, whose surfaces replace those of the map; unset: the map is of a room.
  std::optional<TileWindowConfig> tiles;
  /// The settings from here to picture_every_n_frames trade accuracy for time. Users set them with
  /// RunQuality.
  /// Factor by which depth images are reduced (reduce_depth): 1, 2 or 4.
  int depth_stride = RunQuality{}.depth_stride;
  int tracking_px = RunQuality{}.tracking_px;  ///< max width of the images used for localisation
  int verify_every_n_frames = RunQuality{}.verify_every_n_frames;  ///< see Locator::verify_every_n_frames
  /// True: the dynamic mesh has the image's full resolution near objects.
  bool fine_mesh = RunQuality{}.fine_mesh;
  /// Each object is advanced in every n-th frame; objects alternate.
  int move_every_n_frames = RunQuality{}.move_every_n_frames;
  /// Max deviation, in pixels, of the drawn level of detail from the full mesh.
  double object_error_px = RunQuality{}.object_error_px;
  /// In every n-th frame, at most one shadow is computed at full resolution.
  int shadow_every_n_frames = RunQuality{}.shadow_every_n_frames;
  /// A picture is made in every n-th frame. If > 1, objects are advanced only in frames without a picture.
  int picture_every_n_frames = RunQuality{}.picture_every_n_frames;
  bool make_picture = true;  ///< false: pictures are not drawn; objects are simulated as usual
  /// Called before each processing stage of a frame, and with kDone after the last one. A returned quality
  /// takes effect at once, for the stage that begins. With kDone, the returned quality is ignored. Null: not
  /// called.
  std::function<std::optional<RunQuality>(FramePart, const FrameLoad&)> watch;
  /// true: after each frame, Cyber Radar in its exact mode measures the max penetration depth of objects into
  /// the room and each other, along gravity.
  bool measure_penetration = false;
};

}  // namespace roomradar
