// atlas_fill.hpp: fills the gaps of an atlas, so that neither interpolation nor compression shows its seams.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Gives pixels without colour the mean of their nearest neighbours with colour: the picture is halved until
/// all pixels have a colour, and the gaps are filled on the way back. A picture without any colour becomes
/// grey.
/// @param has_colour  255: the pixel has a colour; 0: the pixel is filled. Same size as the atlas
/// Source: Gortler et al., The Lumigraph, SIGGRAPH 1996 (push-pull).
void fill_gaps(ColourImage& atlas, const MaskImage& has_colour);

}  // namespace roomradar
