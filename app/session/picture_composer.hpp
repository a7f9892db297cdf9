// picture_composer.hpp: composes the camera's picture with the virtual objects and their shadows.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/render/draw.hpp"
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

  /// Notes whether a frame has colour; the first call for each frame. Without colour for half a second,
  /// pictures show the depth.
  void begin_frame(const Frame& frame);
  /// Keeps the colour of a localised frame, with the pose at the time of the colour image. dt_s is the time
  /// since the previous frame.
  void keep_colour(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s);
  /// Composes the picture of a localised frame. At most one shadow is recomputed, in full resolution only if
  /// may_refine_shadow.
  void compose(const Frame& frame, const Eigen::Isometry3d& T_world_camera, bool may_refine_shadow);
  /// Makes the camera's own picture, without objects, the picture of a frame that is not localised.
  void show_camera_alone(const Frame& frame);
  /// Sets the pose that the next frame's motion starts from; unset if the frame is not localised. The last
  /// call for each frame.
  void end_frame(const std::optional<Eigen::Isometry3d>& T_world_camera) { T_world_before_ = T_world_camera; }

  [[nodiscard]] const ColourImage& picture() const { return picture_; }
  /// Unset before the first localised frame with a picture.
  [[nodiscard]] const std::optional<ShownView>& shown_view() const { return shown_view_; }

 private:
  FrameScene& scene_;
  const std::vector<std::unique_ptr<VirtualObject>>& objects_;
  const SessionConfig& config_;
  ObjectDrawer drawer_;
  ObjectLayer layer_;
  Occlusion occlusion_;
  DepthImage real_depth_m_;  ///< as seen by the colour camera, in the rectangle around objects
  std::optional<Eigen::Isometry3d> T_world_before_;  ///< the previous frame's pose, if localised
  std::optional<ShownView> shown_view_;
  std::optional<ShownView> colour_view_;          ///< view of the last colour image, while that is recent
  static constexpr int kColourLasts_frames = 15;  ///< half a second of a Kinect's frames
  int frames_without_colour_ = kColourLasts_frames + 1;  ///< since the last colour image
  std::size_t last_shadow_ = 0;  ///< index of the object whose shadow was renewed last
  ColourImage background_;
  ColourImage picture_;

  /// Returns the view to show: that of the last colour image, or the depth camera's.
  ShownView view_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Recomputes the contact shadow of one object that has turned, or come to rest.
  void renew_a_shadow(bool may_refine);
};

}  // namespace roomradar
