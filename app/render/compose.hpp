// compose.hpp: put the virtual objects into the camera's picture, hidden by what is nearer, and with shadows.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "app/render/contact_shadow.hpp"
#include "app/render/object_layer.hpp"
#include "app/render/occlusion.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct ComposeConfig {
  OcclusionConfig occlusion;
  float shadow_strength = 0.75F;  ///< 0 none .. 1: black where the object covers the whole sky
};
/// Throws Error "compose.shadow_strength = 2: must be in 0..1" and the like.
void require_valid(const ComposeConfig& config);

/// An object that darkens what is below it.
struct ShadowCaster {
  const ContactShadow* shadow = nullptr;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
};

/// The pixels whose real depth shadows and objects look at: those of the layer, about it, and of the shadows.
/// Only these need rendering.
PixelRect pixels_to_compose(std::span<const ShadowCaster> casters, const Intrinsics& camera,
                            const Eigen::Isometry3d& T_world_camera, const ObjectLayer& layer,
                            const OcclusionConfig& config);

/// The picture of the room with the objects' shadows in it, and not yet the objects.
///
/// @param background       the camera's picture, of its size: the live colour, or the depth by shade_depth
/// @param camera           the (colour) camera
/// @param T_world_camera   its pose
/// @param real_depth_m     real surfaces as this camera sees them, of its size; 0 takes no shadow
/// @param casters          objects that cast a soft shadow on real surfaces
/// @param strength         0 none .. 1: black where an object covers the whole sky
/// @param picture          out, of the camera's size; may not be `background`
/// @throws Error if sizes disagree
/// Only the shadows' rectangles cost time beyond one copy.
void cast_shadows(const ColourImage& background, const Intrinsics& camera,
                  const Eigen::Isometry3d& T_world_camera, const DepthImage& real_depth_m,
                  std::span<const ShadowCaster> casters, float strength, ColourImage& picture);

/// Lays the objects over the picture that has their shadows.
///
/// @param layer         the objects as the picture's camera sees them (ObjectDrawer)
/// @param real_depth_m  real surfaces, of the picture's size; 0 hides nothing
/// @param occlusion     what hides the objects; buffers that are reused
/// @throws Error if sizes disagree, or the layer reaches past the picture
void lay_objects(const ObjectLayer& layer, const DepthImage& real_depth_m, const OcclusionConfig& config,
                 Occlusion& occlusion, ColourImage& picture);

/// A grey picture of a depth image, lit from the camera, for sources without colour. Pixels without depth are
/// dark.
void shade_depth(const DepthImage& depth_m, const Intrinsics& camera, ColourImage& picture);

}  // namespace roomradar
