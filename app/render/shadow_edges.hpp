// shadow_edges.hpp: depth along the edges of shadows, aligned to the colour image.
#pragma once
#include "mapping/types/image.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Corrects depth where a shadow ends at a depth edge, i.e. where a nearer surface begins. This edge is
/// ragged in the depth image and displaced by some pixels. Each pixel within reach_px of the edge is compared
/// with pixels away from depth edges, weighted by similarity of colour and by distance. It is assigned to the
/// surface with the largest sum of weights, and gets the depth of the plane fitted to that surface's pixels.
/// Pixels without such a surface keep their depth.
///
/// Source of the weights: Kopf et al., Joint bilateral upsampling, SIGGRAPH 2007.
///
/// @param camera_image  colour image without shadows
/// @param rect          rectangle of camera_image in which shadows may lie
/// @param depth_m       depth of real surfaces in the pixels of `rect`; 0: no surface
/// @param reach_px      max distance between an edge in the depth image and in the colour image, px.
///                      0: nothing is changed
/// @param light_left    fraction of light that the shadows leave in the pixels of `rect`, 0 to 1
/// @param[out] aligned_m  corrected depth, with the size of `rect`; 0 in pixels that keep their depth
/// @return false if no shadow ends at a depth edge, so that all pixels keep their depth
bool align_shadow_edges(const ColourImage& camera_image, const PixelRect& rect, const DepthImage& depth_m,
                        int reach_px, const Image<float>& light_left, DepthImage& aligned_m);

}  // namespace roomradar
