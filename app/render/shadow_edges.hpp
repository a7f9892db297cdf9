// shadow_edges.hpp: depth along the edges of shadows, aligned to the colour image.
#pragma once
#include "mapping/types/image.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Corrects depth where a shadow ends at a depth edge, i.e. where a nearer surface begins. This edge is ragged
/// in the depth image and displaced by some pixels. Each pixel within reach_px of it is compared with pixels
/// away from depth edges, is assigned to the surface of most of those that are similar in colour and near, and
/// gets the depth of the plane through them. Pixels without any of similar colour keep their depth.
///
/// Source of the weights: Kopf et al., Joint bilateral upsampling, SIGGRAPH 2007.
///
/// @param camera_image  colour image without shadows
/// @param depth_m       depth of real surfaces, with the size of camera_image; 0: no surface
/// @param rect          rectangle of the image in which shadows may lie
/// @param reach_px      max distance between an edge in the depth image and in the colour image, px; 0:
/// nothing
///                      is changed
/// @param light_left    fraction of light that the shadows leave, 0 to 1, with the size of `rect`
/// @param[out] aligned_m  corrected depth, with the size of `rect`; 0 in pixels that keep their depth
void align_shadow_edges(const ColourImage& camera_image, const DepthImage& depth_m, const PixelRect& rect,
                        int reach_px, const Image<float>& light_left, DepthImage& aligned_m);

}  // namespace roomradar
