// scan_picture.hpp: the camera's picture in the scan window, tinted by the scan's knowledge of each surface
// point.
#pragma once
#include "app/scan/live/knowledge_grid.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Sets `picture` to the frame's colour image or, without one, to its depth as grey: white at 0.5 m, dark at
/// 5 m, black without depth.
void make_picture(const Frame& frame, ColourImage& picture);

/// Returns a tint for the picture of make_picture(), with one pixel per 8 x 8 pixels of the picture: RGBA,
/// red in the lowest byte. Knowledge::kWell is green and kThin is amber. kNew and kNone have no tint.
Image<std::uint32_t> make_tint(const Frame& frame, const Image<Knowledge>& knowledge);

/// Replaces `picture` by the mean of `picture` and `last_good`, the last picture with a known camera pose.
void mix_half(const ColourImage& last_good, ColourImage& picture);

}  // namespace roomradar
