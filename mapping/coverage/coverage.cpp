// coverage.cpp: holes in observed space and in the surface, and a picture of both.
#include "mapping/coverage/coverage.hpp"

#include "mapping/coverage/coverage_picture.hpp"
#include "mapping/coverage/frontier.hpp"
#include "mapping/types/codecs/png.hpp"

namespace roomradar {

Coverage survey_coverage(const StaticMap& octree, const Mesh& mesh,
                         const std::vector<TimedPose>& trajectory) {
  const Frontier frontier = find_frontier(octree);
  Coverage coverage;
  coverage.holes = find_holes(octree, mesh, frontier);
  coverage.picture_png = encode_png(draw_coverage(octree, mesh, frontier, coverage.holes, trajectory));
  return coverage;
}

}  // namespace roomradar
