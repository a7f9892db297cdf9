// scan_picture.hpp: the camera's picture in the scan window, tinted by how well each place is known.
#pragma once
#include "app/scan/live/knowledge_grid.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Sets `picture` to the frame's colour image or, without one, to its depth as grey: white at 0.5 m, dark at
/// 5 m, black without depth.
void make_picture(const Frame& frame, ColourImage& picture);

/// Returns a tint for the whole picture of make_picture(), one pixel per 8 x 8 of the picture: RGBA, red in
/// the lowest byte. Well known places are green, thinly known ones amber; new ones and those without depth
/// have no tint.
Image<std::uint32_t> make_tint(const Frame& frame, const Image<Knowledge>& knowledge);

/// Mixes the last picture with a known pose half over the current one.
void mix_half(const ColourImage& last_good, ColourImage& picture);

}  // namespace roomradar
