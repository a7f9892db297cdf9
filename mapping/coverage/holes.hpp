// holes.hpp: unobserved regions of a scan, with places from which a person can observe them.
#pragma once
#include <string>
#include <vector>

#include "mapping/coverage/hole.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

class StaticMap;
struct Frontier;

/// Returns the frontier's holes, and the holes of the surface: border loops surrounded by surface, at least
/// min_border_size_m across. Loops whose centre is within three cells of a frontier hole's cell are left out.
/// Sorted by kind, then largest first.
std::vector<Hole> find_holes(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                             double min_border_size_m = 0.12);

/// Returns text such as "unknown space at (1.20, -0.35, 0.40) m, 0.80 m wide, 0.31 m2; look along (0.87,
/// -0.40, -0.30) from (0.16, 0.13, 0.76)".
std::string describe(const Hole& hole);

}  // namespace roomradar
