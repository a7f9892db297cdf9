// exposure_gains.hpp: evens the exposure of views by the surface that they share.
#pragma once
#include <span>

#include "mapping/texture/texture_view.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets TextureView::gain of all views. Each channel of each view gets the factor that brings its colours to
/// the median colour of some thousand points of the surface, over all views that show them. Medians leave
/// highlights, shadows and things that moved without effect. Views that share less than 20 points with others
/// keep gain 1. The geometric mean of the gains is 1, or less where more than 2 % of the surface would be
/// white.
/// @param mesh  with normals
void even_exposure(const Mesh& mesh, std::span<TextureView> views);

}  // namespace roomradar
