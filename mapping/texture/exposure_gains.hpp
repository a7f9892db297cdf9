// exposure_gains.hpp: equalises the exposure of views, from surface points that several views show.
#pragma once
#include <span>

#include "mapping/texture/texture_view.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets TextureView::gain of all views. The gain of a channel brings the view's colours to the median over
/// all views, at some thousand surface points. Medians suppress the effect of highlights, shadows and moved
/// objects. Only points that several views show are used; a view with fewer than 20 such points has gain 1.
/// The geometric mean of the other gains is 1. If more than 2 % of the points would be white, all gains are
/// finally scaled down, to at least 60 %.
/// @param mesh  with normals
void even_exposure(const Mesh& mesh, std::span<TextureView> views);

}  // namespace roomradar
