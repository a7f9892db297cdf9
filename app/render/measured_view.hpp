// measured_view.hpp: what a frame measured, as seen from the picture's camera.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// What one frame measured, in a rectangle of another camera's image. Both images have the size of that
/// image; pixels outside the rectangle are undefined.
struct MeasuredView {
  PixelRect rect;
  DepthImage depth_m;    ///< along that camera's optical axis; 0: nothing was measured there
  MaskImage is_dynamic;  ///< not 0: the measured surface is not the static room
  MaskImage is_revealed;  ///< not 0: the measured surface was behind a part of the static room that is gone
  /// Set by bridge_gaps(). Not 0: a measured dynamic pixel, or an unmeasured one whose surface was decided by
  /// colour.
  MaskImage is_decided;
  // Scratch of bridge_gaps().
  MaskImage is_near;
  std::vector<int> counts;
};

/// What one frame measured. Refers to its parts, which must outlive it.
struct MeasuredFrame {
  const DepthImage& depth_m;  ///< 0: no measurement
  const MaskImage&
      dynamic_mask;          ///< not 0: dynamic; of any size, scaled to that of depth_m. Empty: nothing is
  const Intrinsics& camera;  ///< of the depth image
  /// Not 0: measured behind a part of the static room that is gone; of any size, as dynamic_mask. Empty:
  /// nothing is gone.
  const MaskImage& revealed_mask;
};

/// Projects measured depth into another camera. Each measured pixel covers as much of the view as its share
/// of the depth image; cracks one pixel wide are closed. The nearer surface hides the farther.
/// @param T_view_depth  maps points of the depth camera to the view's camera
/// @param rect          pixels of the view to set, within the view
void view_measured(const MeasuredFrame& frame, const Eigen::Isometry3d& T_view_depth,
                   const Intrinsics& view_camera, const PixelRect& rect, MeasuredView& view);

/// Adds what was measured to the depth of the modelled surfaces, which are smoother and complete. A
/// measurement counts where there is no model, and where it is nearer than the model by more than its error
/// and several of its neighbours on the same surface are nearer, too, or dynamic. So a surface hides what is
/// behind it, whether or not it belongs to any model. A measurement also counts where it is revealed: a part
/// of the room that is gone hides nothing.
/// @param noise   of the sensor
/// @param[in,out] real_depth_m  depth of the modelled surfaces in the view, with its size, 0: none
void add_measured(const MeasuredView& view, const DepthNoise& noise, DepthImage& real_depth_m);

/// Gives unmeasured pixels the depth of a dynamic surface, if they belong to it by their colour. A hand may
/// be measured in patches only, as where it is dark or shiny; but beside it, in the shadow of the sensor's
/// light, nothing is measured either. Each unmeasured pixel within 20 pixels of a dynamic one is compared
/// with the measured pixels around it, weighted by similarity of colour and by distance. It joins the dynamic
/// pixels if these are more alike and nearer than the model. Else it keeps the model's depth.
/// In both cases the pixel is decided in the view, as are the measured dynamic pixels.
/// @param camera_image  colour image of the view
/// @param[in,out] real_depth_m  result of add_measured()
///
/// Source of the weights: Kopf et al., Joint bilateral upsampling, SIGGRAPH 2007, with tails as those of a
/// Student distribution.
void bridge_gaps(const ColourImage& camera_image, MeasuredView& view, DepthImage& real_depth_m);

}  // namespace roomradar
