// picture_composer.hpp: composes the camera's picture with the virtual objects and their shadows.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/objects/object_light.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/render/draw.hpp"
#include "app/render/hatched_patch.hpp"
#include "app/render/light_estimate.hpp"
#include "app/render/measured_view.hpp"
#include "app/render/occlusion.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/session_config.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Camera model and pose from which a picture is seen.
struct ShownView {
  Intrinsics camera;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Not thread safe: call all functions on the constructing thread, whose GL context is used.
class PictureComposer {
 public:
  /// All arguments must outlive the composer. Changes of `config` take effect at the next call.
  PictureComposer(GlContext& context, FrameScene& scene,
                  const std::vector<std::unique_ptr<VirtualObject>>& objects, const SessionConfig& config);

  /// First call for each frame. After 15 frames without a colour image, pictures show the shaded depth image
  /// instead.
  void begin_frame(const Frame& frame);
  /// Stores the colour image of a localised frame, with the pose at the colour image's timestamp, and updates
  /// the estimate of the room's light. Call it after the scene has found the frame's dynamic pixels.
  /// @param dt_s  time since the previous frame
  void keep_colour(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s);
  /// Composes the picture of a localised frame. Recomputes the shadow of at most one object, on a grid of 8
  /// cells across, or of 16 if the object is asleep and may_refine_shadow is true.
  void compose(const Frame& frame, const Eigen::Isometry3d& T_world_camera, bool may_refine_shadow);
  /// Call instead of compose() for a frame that is not localised. The picture is the camera's own image,
  /// without objects.
  void show_camera_alone(const Frame& frame);
  /// Last call for each frame. Stores the pose, unset if the frame is not localised, to compute the camera's
  /// motion to the next frame.
  void end_frame(const std::optional<Eigen::Isometry3d>& T_world_camera) { T_world_before_ = T_world_camera; }

  [[nodiscard]] const ColourImage& picture() const { return picture_; }
  /// The drawn objects of the last picture, and how much real surfaces occlude them.
  [[nodiscard]] const ObjectLayer& layer() const { return layer_; }
  [[nodiscard]] const Occlusion& occlusion() const { return occlusion_; }
  /// The room's light as estimated from the colours so far; unset before the first colours.
  [[nodiscard]] const std::optional<RoomLight>& room_light() const { return light_.estimator.light(); }
  /// Standard deviation of the camera's brightness noise, in grey levels of 0..255; 0 before the first
  /// colours.
  [[nodiscard]] float noise() const { return light_.noise; }
  /// Camera and pose of the picture. Unset before the first localised frame with a picture, and after a frame
  /// that is not localised.
  [[nodiscard]] const std::optional<ShownView>& shown_view() const { return shown_view_; }

 private:
  static constexpr int kColourLasts_frames = 15;  ///< half a second at a Kinect's 30 frames/s
  struct LastColour {
    std::optional<ShownView> view;                 ///< unset if older than kColourLasts_frames
    int frames_without = kColourLasts_frames + 1;  ///< number of frames since
  };
  struct Light {
    LightEstimator estimator;
    std::vector<LightSample> samples;  ///< buffer
    std::uint64_t position = 0;        ///< position in the sequence of sampled pixels
    std::vector<SplitLight> objects;   ///< buffer: light of each drawn object
    float noise = 0.0F;                ///< standard deviation of the camera's noise, of 255; smoothed
  };
  struct Buffers {
    /// Depth of the real surfaces in the picture's view, in the pixels around objects.
    DepthImage real_depth_m;
    MaskImage revealed_mask;            ///< see MeasuredFrame
    MeasuredView measured;              ///< what the frame measured, in the picture's view
    std::vector<HatchedPatch> patches;  ///< hatched areas under objects that rest on unknown space
    ObjectReaches reaches;              ///< in the order of the objects
    Feet feet;
    ColourImage background;
  };

  FrameScene& scene_;
  const std::vector<std::unique_ptr<VirtualObject>>& objects_;
  const SessionConfig& config_;
  ObjectDrawer drawer_;
  ObjectLayer layer_;
  Occlusion occlusion_;
  /// Pose of the previous frame; unset if it was not localised.
  std::optional<Eigen::Isometry3d> T_world_before_;
  std::optional<ShownView> shown_view_;
  LastColour colour_;
  Light light_;
  Buffers buffers_;
  std::uint64_t pictures_ = 0;   ///< number of composed pictures; seed of the grain
  std::size_t last_shadow_ = 0;  ///< index of the object whose shadow was recomputed last
  ColourImage picture_;

  /// Returns the view of the last colour image, or that of the depth camera if there is none.
  ShownView view_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  /// Updates the light at the middle of the objects in the room, from the stored colour image.
  void estimate_light(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double dt_s);
  /// Returns an object's shadow, in the light that arrives at it.
  [[nodiscard]] static ShadowCaster caster_of(const VirtualObject& object, const SplitLight* light);
  /// Sets buffers_.feet (level planes through the lowest points of objects) from the objects in the room.
  void find_feet(const ShownView& view);
  /// Recomputes the contact shadow of one object that has rotated by more than 0.05 rad or has fallen asleep.
  void renew_a_shadow(bool may_refine);
};

}  // namespace roomradar
