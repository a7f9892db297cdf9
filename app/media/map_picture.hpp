// map_picture.hpp: a map's surface seen obliquely from above, with what changed painted over.
#pragma once
#include <span>

#include "mapping/map/map_diff.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// An orthographic view from above and one side; surfaces that look away (the ceiling, the near walls) are
/// left out. The mesh is drawn in its own colours, paled; what appeared is green, what vanished red.
/// @param width_px  of the picture; its height follows from the map
/// @return an empty image for an empty mesh
ColourImage draw_changes(const Mesh& mesh, std::span<const Change> changes, int width_px = 1200);

}  // namespace roomradar
