// map_picture.hpp: renders a map's surface obliquely from above, with changes highlighted.
#pragma once
#include <span>

#include "mapping/map/map_diff.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Renders an orthographic view from above and one side; faces turned away (the ceiling, the near walls) are
/// culled. The mesh has its own colours, paled; appeared surfaces are green, vanished surfaces red.
/// @param width_px  of the picture; its height follows from the map
/// @return an empty image for an empty mesh
ColourImage draw_changes(const Mesh& mesh, std::span<const Change> changes, int width_px = 1200);

}  // namespace roomradar
