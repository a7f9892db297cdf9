// coverage.cpp: holes of space and of the surface, and the picture of both.
#include "mapping/coverage.hpp"

#include "mapping/coverage_picture.hpp"
#include "mapping/frontier.hpp"

namespace roomradar {

Coverage survey_coverage(const SavedMap& map) {
  const Frontier frontier = find_frontier(map.octree);
  Coverage coverage;
  coverage.holes = find_holes(map.octree, map.mesh, frontier);
  coverage.picture_png =
      encode_png(draw_coverage(map.octree, map.mesh, frontier, coverage.holes, map.trajectory));
  return coverage;
}

}  // namespace roomradar
