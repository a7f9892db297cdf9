// compose.hpp: composes virtual objects into the camera's picture, with occlusion and shadows.
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
  float shadow_strength = 0.75F;  ///< 0: none; 1: black where the object occludes the whole sky
};
/// Throws Error such as "compose.shadow_strength = 2: must be in 0..1".
void require_valid(const ComposeConfig& config);

/// An object that casts a shadow on surfaces below it.
struct ShadowCaster {
  const ContactShadow* shadow = nullptr;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
};

/// Returns the pixels whose real depth is needed: those of the layer with the occlusion margin, and of the
/// shadows.
PixelRect pixels_to_compose(std::span<const ShadowCaster> casters, const Intrinsics& camera,
                            const Eigen::Isometry3d& T_world_camera, const ObjectLayer& layer,
                            const OcclusionConfig& config);

/// Copies the background with the objects' shadows, without the objects themselves.
///
/// @param background       the camera's picture, of its size: live colour, or depth shaded by shade_depth()
/// @param camera           the (colour) camera
/// @param T_world_camera   its pose
/// @param real_depth_m     real surfaces in this camera, of its size; pixels of 0 get no shadow
/// @param casters          objects that cast a soft shadow on real surfaces
/// @param strength         0: none; 1: black where an object occludes the whole sky
/// @param picture          out, of the camera's size; must not be `background`
/// @throws Error if sizes disagree
/// Beyond one copy, only the shadows' rectangles cost time.
void cast_shadows(const ColourImage& background, const Intrinsics& camera,
                  const Eigen::Isometry3d& T_world_camera, const DepthImage& real_depth_m,
                  std::span<const ShadowCaster> casters, float strength, ColourImage& picture);

/// Blends the objects over the picture that already has their shadows.
///
/// @param layer         the objects in the picture's camera (ObjectDrawer)
/// @param real_depth_m  real surfaces, of the picture's size; 0 occludes nothing
/// @param occlusion     out: occlusion of the objects; reused buffers
/// @throws Error if sizes disagree, or the layer exceeds the picture
void lay_objects(const ObjectLayer& layer, const DepthImage& real_depth_m, const OcclusionConfig& config,
                 Occlusion& occlusion, ColourImage& picture);

/// Renders a depth image as a grey picture lit from the camera, for sources without colour. Pixels without
/// depth are dark.
void shade_depth(const DepthImage& depth_m, const Intrinsics& camera, ColourImage& picture);

}  // namespace roomradar
