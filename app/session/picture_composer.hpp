// picture_composer.hpp: composes the camera's picture with the virtual objects and their shadows.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/render/draw.hpp"
#include "app/render/hatched_patch.hpp"
#include "app/render/occlusion.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/session_config.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Camera and pose of a picture.
struct ShownView {
  Intrinsics camera;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Not thread safe; GL calls are made on the constructing thread.
class PictureComposer {
 public:
  /// All arguments must outlive the composer; config is read at each call.
  PictureComposer(GlContext& context, FrameScene& scene,
                  const std::vector<std::unique_ptr<VirtualObject>>& objects, const SessionConfig& config);

  /// First call for each frame. If no frame has had colour for half a second, pictures show the depth.
  void begin_frame(const Frame& frame);
  /// Keeps the colour of a localised frame, with the pose at the time of the colour image. dt_s is the time
  /// since the previous frame.
  void keep_colour(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s);
  /// Composes the picture of a localised frame. Recomputes at most one shadow, at full resolution only if
  /// may_refine_shadow.
  void compose(const Frame& frame, const Eigen::Isometry3d& T_world_camera, bool may_refine_shadow);
  /// For a frame that is not localised: the picture is the camera's own image, without objects.
  void show_camera_alone(const Frame& frame);
  /// Last call for each frame. Stores the pose, from which the motion to the next frame is computed; unset if
  /// the frame is not localised.
  void end_frame(const std::optional<Eigen::Isometry3d>& T_world_camera) { T_world_before_ = T_world_camera; }

  [[nodiscard]] const ColourImage& picture() const { return picture_; }
  /// Camera and pose of the picture; unset before the first localised frame with a picture.
  [[nodiscard]] const std::optional<ShownView>& shown_view() const { return shown_view_; }

 private:
  FrameScene& scene_;
  const std::vector<std::unique_ptr<VirtualObject>>& objects_;
  const SessionConfig& config_;
  ObjectDrawer drawer_;
  ObjectLayer layer_;
  Occlusion occlusion_;
  DepthImage real_depth_m_;  ///< depth of the real surfaces in the shown view, around objects
  std::optional<Eigen::Isometry3d> T_world_before_;  ///< the previous frame's pose, if localised
  std::optional<ShownView> shown_view_;
  std::optional<ShownView> colour_view_;                 ///< view of the last colour image, if recent
  static constexpr int kColourLasts_frames = 15;         ///< half a second of a Kinect's frames
  int frames_without_colour_ = kColourLasts_frames + 1;  ///< since the last colour image
  std::vector<HatchedPatch> patches_;                    ///< scratch: under objects on unknown space
  std::size_t last_shadow_ = 0;  ///< index of the object whose shadow was renewed last
  ColourImage background_;
  ColourImage picture_;

  /// Returns the view to show: that of the last colour image, or the depth camera's.
  ShownView view_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Recomputes the contact shadow of one object that has turned, or come to rest.
  void renew_a_shadow(bool may_refine);
};

}  // namespace roomradar
