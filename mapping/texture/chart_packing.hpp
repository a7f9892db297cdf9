// chart_packing.hpp: places charts in one atlas.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/texture/texture_charts.hpp"

namespace roomradar {

/// Sets size_px and corner_px of the charts such that no two overlap. Rotates charts that are higher than
/// wide by a quarter turn. Packs the charts in rows, by descending height. If they do not fit into
/// max_side_px x max_side_px texels, all texels are enlarged by the same factor.
/// @return size of the atlas: multiples of 16, at most max_side_px (a multiple of 16). 0 x 0 if there are too
///         many charts for any size of texel
Eigen::Vector2i pack(std::vector<TextureChart>& charts, int max_side_px);

}  // namespace roomradar
