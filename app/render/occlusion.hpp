// occlusion.hpp: occlusion of virtual objects by real surfaces, with edges aligned to the colour image.
#pragma once
#include <cstdint>
#include <vector>

#include "app/render/object_layer.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct OcclusionConfig {
  float tolerance_m = 0.006F;       ///< a real surface occludes only if nearer by this at 1 m
  float tolerance_per_m2 = 0.003F;  ///< and by this more per squared metre of distance, for sensor noise
  float softness_m = 0.004F;        ///< depth range of the fade-out, to avoid hard lines at contacts
  /// Max distance of a measured surface's edge from the edge in colour; 0: occlusion by depth alone.
  int edge_reach_px = 5;
};
/// Throws Error such as "occlusion.softness_m = 0: must be in 0..1, not 0".
void require_valid(const OcclusionConfig& config);

/// Occlusion of the objects in a rectangle of the picture, with reused buffers.
struct Occlusion {
  PixelRect rect;       ///< the layer's rectangle plus occlusion_margin_px(), within the picture
  Image<float> hidden;  ///< 0: object fully visible; 1: fully occluded
  ColourImage front;    ///< colour of the occluder, without background mixed in at its edge

  Image<float> object_m, unsoftened;
  MaskImage covered;             ///< at least partly covered by an object
  Image<std::uint8_t> by_depth;  ///< 255: occluded
  MaskImage edges;
  Image<int> near_edges, near_hidden;  ///< sums over the neighbourhood
  std::vector<int> column_sums;
  struct EdgePixel {
    int x, y;    ///< in the rectangle
    float odds;  ///< log odds of occlusion, from depth and own colour
    Rgb front;   ///< mean colour of nearby occluders
  };
  std::vector<EdgePixel> band;
};

/// Returns the number of pixels beyond the layer's rectangle that find_occlusion() reads.
int occlusion_margin_px(const OcclusionConfig& config);

/// Computes how much real surfaces occlude the objects. Depth tells which surface is in front, but its edges
/// are ragged and off by pixels. Colour has sharp edges, but does not tell which side is in front. In a band
/// of edge_reach_px around each occluder's edge, every pixel is therefore assigned to the side whose colours
/// match. Each side is a Gaussian of the colours beyond the band; the prior is the fraction of the
/// neighbourhood that depth calls occluded. Where both sides look alike, and where the object dips into a
/// surface, depth's edge is kept. Finally `hidden` is averaged over 3 x 3 pixels.
///
/// @param background    the camera's picture, with the objects' shadows
/// @param real_depth_m  real surfaces in that camera, of its size; 0 occludes nothing
/// @param layer         the objects, within the picture
/// Source: colour models and band as in Chuang et al., A Bayesian approach to digital matting, CVPR 2001,
/// with one Gaussian per side and opaque pixels.
void find_occlusion(const ColourImage& background, const DepthImage& real_depth_m, const ObjectLayer& layer,
                    const OcclusionConfig& config, Occlusion& occlusion);

}  // namespace roomradar
