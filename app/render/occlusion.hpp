// occlusion.hpp: how much real surfaces hide of the virtual objects, with edges where the colours have them.
#pragma once
#include <cstdint>
#include <vector>

#include "app/render/object_layer.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct OcclusionConfig {
  float tolerance_m = 0.006F;       ///< a real surface must be nearer by this at 1 m to hide the object
  float tolerance_per_m2 = 0.003F;  ///< and by this more per squared metre of distance: sensor noise
  float softness_m = 0.004F;        ///< over this depth the object fades out: no hard line where it touches
  /// The edge of a measured surface may lie this far from where the colours show it; 0: depth alone decides.
  int edge_reach_px = 5;
};
/// Throws Error "occlusion.softness_m = 0: must be in 0..1, not 0" and the like.
void require_valid(const OcclusionConfig& config);

/// What hides the objects in the pixels of a rectangle of the picture, and buffers that are reused.
struct Occlusion {
  PixelRect rect;       ///< the layer's, grown as far as its edges look, within the picture
  Image<float> hidden;  ///< 0: all of the object shows .. 1: none
  ColourImage front;    ///< what hides it there, without what shows through at its edge

  Image<float> object_m, unsoftened;
  MaskImage covered;             ///< by an object, in part at least
  Image<std::uint8_t> by_depth;  ///< 255: hidden
  MaskImage edges;
  Image<int> near_edges, near_hidden;  ///< sums over the neighbourhood
  std::vector<int> column_sums;
  struct EdgePixel {
    int x, y;    ///< in the rectangle
    float odds;  ///< logarithm of those that it is hidden, by depth and its own colour
    Rgb front;   ///< mean colour of what hides things here
  };
  std::vector<EdgePixel> band;
};

/// The pixels beyond the layer's that find_occlusion looks at.
int occlusion_margin_px(const OcclusionConfig& config);

/// Depth says what is in front, but its edges are ragged and pixels off; colour has sharp edges, but does not
/// say of what. So where a nearer surface ends, in a band of edge_reach_px, each pixel goes to the side whose
/// colours it has: a Gaussian of the colours beyond the band on either side, with the part of the
/// neighbourhood that depth calls hidden as the prior. Where both sides look alike, depth's edge stays. Edges
/// where the object dips into a surface are depth's alone. At last hidden is averaged over 3 x 3 pixels.
///
/// @param background    the camera's picture, with the objects' shadows
/// @param real_depth_m  real surfaces as that camera sees them, of its size; 0 hides nothing
/// @param layer         the objects, within the picture
/// Source: the colour models and the band are those of Chuang et al., A Bayesian approach to digital
/// matting, CVPR 2001, with one Gaussian a side and opaque pixels.
void find_occlusion(const ColourImage& background, const DepthImage& real_depth_m, const ObjectLayer& layer,
                    const OcclusionConfig& config, Occlusion& occlusion);

}  // namespace roomradar
