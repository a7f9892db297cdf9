// compose.hpp: composes virtual objects into the camera image, with occlusion and shadows.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/render/contact_shadow.hpp"
#include "app/render/light_estimate.hpp"
#include "app/render/object_layer.hpp"
#include "app/render/occlusion.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct ComposeConfig {
  OcclusionConfig occlusion;
  bool bridge_gaps = true;  ///< see bridge_gaps() in measured_view.hpp
  /// Darkness of shadows, 0 to 1. 0: no shadows. 1: points from which objects occlude the whole sky are
  /// black.
  float shadow_strength = 0.75F;
  LightConfig light;
  /// True: objects get the camera's noise.
  bool has_grain = true;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const ComposeConfig& config);

/// An object that casts a shadow on surfaces below it. `shadow` was computed for an orientation close to the
/// object's current one.
struct ShadowCaster {
  const ContactShadow* shadow = nullptr;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  /// Direction towards the main light, unit, and its fraction of all light on a level surface. 0: only
  /// ambient light.
  Eigen::Vector3f to_light_world = Eigen::Vector3f::UnitZ();
  float directed_fraction = 0.0F;
};

/// Returns the rectangle of pixels in which the functions below need the depth of real surfaces. The
/// rectangle contains the object layer, enlarged by occlusion_margin_px(), and the shadows.
PixelRect pixels_to_compose(std::span<const ShadowCaster> casters, const Intrinsics& camera,
                            const Eigen::Isometry3d& T_world_camera, const ObjectLayer& layer,
                            const OcclusionConfig& config);

/// Copies the background and darkens it by the objects' shadows, from ambient light and from the casters'
/// main lights. Along depth edges, shadows end where colours change, see align_shadow_edges(). Does not draw
/// the objects. The run time is that of one copy, plus a time proportional to the area of the shadows'
/// rectangles.
///
/// @param background    colour image of the camera, or result of shade_depth(). Must have the size of
///                      real.camera
/// @param real          depth of real surfaces in the colour camera. Pixels with depth 0 get no shadow
/// @param casters       objects that cast a shadow
/// @param config        shadow_strength and occlusion.edge_reach_px are used
/// @param is_decided    of the size of real.camera; not 0 where the real depth agrees with the colours
///                      already. Null: nowhere
/// @param[out] picture  resized to the size of real.camera; must not be `background`
/// @throws Error if sizes differ
void cast_shadows(const ColourImage& background, const PosedDepth& real,
                  std::span<const ShadowCaster> casters, const ComposeConfig& config, ColourImage& picture,
                  const MaskImage* is_decided = nullptr);

/// Blends the objects over an image that already contains their shadows.
///
/// @param objects       rendered by ObjectDrawer with the camera of `picture`. Objects are never hidden by
///                      their support at their feet
/// @param real_depth_m  depth of real surfaces, with the size of `picture`. Pixels with depth 0 occlude
///                      nothing
/// @param[out] occlusion    occlusion of the objects; its buffers are reused
/// @param[in,out] picture   image with the objects' shadows, over which the objects are blended
/// @param camera_image  the image without shadows, in which occluders' edges are found; null: `picture`
/// @throws Error if sizes differ, or the layer exceeds the image
void lay_objects(const RenderedObjects& objects, const DepthImage& real_depth_m,
                 const OcclusionConfig& config, Occlusion& occlusion, ColourImage& picture,
                 const ColourImage* camera_image = nullptr);

/// Renders a depth image as a grey image with a light source at the camera, for sources without colour.
/// Pixels without depth are dark.
void shade_depth(const DepthImage& depth_m, const Intrinsics& camera, ColourImage& picture);

}  // namespace roomradar
