// map_picture.hpp: renders a map's surface obliquely from above, with changes highlighted.
#pragma once
#include <span>

#include "mapping/map/map_diff.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Renders an orthographic view from obliquely above. Back faces, such as those of the ceiling and the near
/// walls, are culled. The mesh has its own colours, lightened. Appeared surfaces are green, vanished surfaces
/// red.
/// @param width_px  width of the picture; its height follows from the map's extent
/// @param ground    colour of the pixels without surface
/// @return an empty image for an empty mesh
ColourImage draw_changes(const Mesh& mesh, std::span<const Change> changes, int width_px = 1200,
                         Rgb ground = {255, 255, 255});

}  // namespace roomradar
