// occlusion.hpp: occlusion of virtual objects by real surfaces, with edges aligned to the colour image.
#pragma once
#include <cstdint>
#include <vector>

#include "app/render/object_layer.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct OcclusionConfig {
  /// A real surface at 1 m occludes an object only if it is nearer than the object by more than this.
  float tolerance_m = 0.006F;
  /// Increase of the tolerance, m, per squared metre of distance, like the sensor's noise.
  float tolerance_per_m2 = 0.003F;
  /// Range of depth differences over which occlusion fades out, to avoid hard lines at contacts.
  float softness_m = 0.004F;
  /// Max distance between an occluder's edge in the depth image and in the colour image, px. 0: occlusion is
  /// decided by depth alone.
  int edge_reach_px = 5;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const OcclusionConfig& config);

/// Occlusion of the objects in a rectangle of the image. Its buffers are reused.
struct Occlusion {
  /// The object layer's rectangle, enlarged by occlusion_margin_px(), within the image.
  PixelRect rect;
  /// Occluded fraction. 0: object fully visible; 1: fully occluded.
  Image<float> hidden;
  /// Colour of the occluder, without the background colour that mixes in at its edge.
  ColourImage front;

  Image<float> object_m, unsoftened;
  /// Pixels at least partly covered by an object (255).
  MaskImage covered;
  /// 255 if the pixel is occluded by depth alone.
  Image<std::uint8_t> by_depth;
  MaskImage edges;
  /// Number of edge pixels and of occluded pixels in each pixel's neighbourhood.
  Image<int> near_edges, near_hidden;
  std::vector<int> column_sums;
  /// A pixel in the band around an occluder's edge.
  struct EdgePixel {
    /// Position in the rectangle.
    int x, y;
    /// Log odds of occlusion, from the pixel's depth and colour.
    float odds;
    /// Mean colour of nearby occluders.
    Rgb front;
  };
  std::vector<EdgePixel> band;
};

/// Returns the number of pixels beyond the layer's rectangle that find_occlusion() reads.
int occlusion_margin_px(const OcclusionConfig& config);

/// Computes how much real surfaces occlude the objects. Depth determines which surface is in front, but its
/// edges are ragged and displaced by pixels. Colour has sharp edges, but does not determine which side is in
/// front. Every pixel in a band of edge_reach_px around each occluder's edge is therefore assigned to the
/// side whose colours match. Each side's colours beyond the band are modelled by a Gaussian. The prior is the
/// fraction of the neighbourhood that is occluded by depth. If both sides have similar colours, or the object
/// intersects a surface, the edge in depth is kept. Finally `hidden` is averaged over 3 x 3 pixels.
///
/// @param background    colour image of the camera, with the objects' shadows
/// @param real_depth_m  depth of real surfaces in that camera, of its size; pixels of 0 occlude nothing
/// @param layer         the rendered objects, within the image
/// @param[out] occlusion  the result
///
/// Source of the colour models and the band: Chuang et al., A Bayesian approach to digital matting, CVPR
/// 2001. Here each side has one Gaussian, and pixels are opaque.
void find_occlusion(const ColourImage& background, const DepthImage& real_depth_m, const ObjectLayer& layer,
                    const OcclusionConfig& config, Occlusion& occlusion);

}  // namespace roomradar
