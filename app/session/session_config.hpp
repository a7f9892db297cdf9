// session_config.hpp: settings of a session.
#pragma once
#include <functional>
#include <optional>

#include "app/physics/physics_config.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "app/render/compose.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/map_updater.hpp"
#include "mapping/types/pose_origin.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

struct SessionConfig {
  PoseOrigin poses = PoseOrigin::kTracked;
  FrameSceneConfig scene;
  RadarConfig radar;
  PhysicsConfig physics;
  ComposeConfig picture;
  std::optional<MapUpdateConfig> map_updates;  ///< unset: the room stays as saved
  /// Settings that trade accuracy for time; users set them through RunQuality.
  int depth_stride = 1;           ///< 1, 2 or 4: factor by which depth images are reduced (reduce_depth)
  int tracking_px = 160;          ///< max width of the images used for localisation
  bool fine_mesh = false;         ///< true: the dynamic mesh has the image's full resolution near objects
  int move_every_n_frames = 1;    ///< each object is moved every n-th frame; objects take turns
  double object_error_px = 0.7;   ///< max deviation of an object's drawn mesh from its file's mesh
  int shadow_every_n_frames = 1;  ///< frames between full recomputations of a shadow
  /// Frames between pictures. If > 1, objects move only in the frames without a picture.
  int picture_every_n_frames = 1;
  bool make_picture = true;  ///< false: no drawing; only the work that moves objects
  /// Called before each part of a frame, and with kDone after the last. A returned quality applies from that
  /// part on; with kDone it is ignored. Null: not called.
  std::function<std::optional<RunQuality>(FramePart, const FrameLoad&)> watch;
  /// true: after each frame, the exact radar measures how deep objects overlap the room and each other, along
  /// gravity.
  bool measure_penetration = false;
};

}  // namespace roomradar
