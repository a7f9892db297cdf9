// holes.hpp: unobserved regions of a scan, with positions from which a person can observe them.
#pragma once
#include <string>
#include <vector>

#include "mapping/coverage/hole.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

class StaticMap;
struct Frontier;

/// Returns the frontier's holes and the mesh's holes. The latter are border loops that do not enclose a
/// component, with a BorderLoop::size_m of at least min_border_size_m. Leaves out loops whose centre is
/// within three cell widths of a frontier hole's cell. Sorts by area, largest first; the scan's outer borders
/// come last.
std::vector<Hole> find_holes(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                             double min_border_size_m = 0.12);

/// Returns text such as "unknown space at (1.20, -0.35, 0.40) m, 0.80 m wide, 0.31 m2; look along (0.87,
/// -0.40, -0.30) from (0.16, 0.13, 0.76)".
std::string describe(const Hole& hole);

}  // namespace roomradar
