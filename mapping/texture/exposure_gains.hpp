// exposure_gains.hpp: equalises the exposure of views by the surface that they share.
#pragma once
#include <span>

#include "mapping/texture/texture_view.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets TextureView::gain of all views. Each channel of each view gets the factor that brings its colours to
/// the median colour of some thousand points of the surface, over all views that show them. Because of the
/// medians, highlights, shadows and moved objects have no effect. Views that share fewer than 20 points with
/// others get gain 1. The geometric mean of the other gains is 1. If more than 2 % of the points would be
/// white, all gains are then lowered, by at most 40 %.
/// @param mesh  with normals
void even_exposure(const Mesh& mesh, std::span<TextureView> views);

}  // namespace roomradar
