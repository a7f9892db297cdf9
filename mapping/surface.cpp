// surface.cpp: smooth the signed distances, span the net, specks out, then fewer triangles.
#include "mapping/surface.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "mapping/mesh_pieces.hpp"
#include "mapping/mesh_simplify.hpp"
#include "mapping/sample_bricks.hpp"
#include "mapping/sample_guess.hpp"
#include "mapping/sample_smoothing.hpp"
#include "mapping/surface_net.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr int kSweeps = 6;               // more change the surface by less than 0.1 mm
constexpr float kSpacing_voxels = 1.5F;  // of the points at which the simplified surface is measured

void require_valid(const SurfaceConfig& config) {
  const auto require = [](const char* field, float value) {
    if (!(std::isfinite(value) && value >= 0.0F))
      throw Error(std::string("surface.") + field + " = " + std::to_string(value) +
                  ": must be finite and >= 0");
  };
  require("min_weight", config.min_weight);
  require("smoothing", config.smoothing);
  require("min_component_area_m2", config.min_component_area_m2);
  require("max_deviation_m", config.max_deviation_m);
}

Mesh full_surface(const StaticMap& map, const SurfaceConfig& config) {
  SampleBricks bricks(map, config.min_weight);
  if (config.smoothing > 0.0F) smooth(bricks, config.smoothing, kSweeps);
  guess_neighbours(bricks);
  return surface_net(bricks, map.resolution_m());
}

}  // namespace

Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config, SurfaceFacts* facts) {
  require_valid(config);
  SimplifiedMesh result{without_specks(full_surface(map, config), config.min_component_area_m2), 0.0F};
  const std::size_t full_triangles = result.mesh.triangles.size();
  if (config.max_deviation_m > 0.0F) {
    const auto spacing_m = kSpacing_voxels * static_cast<float>(map.resolution_m());
    result = simplified(std::move(result.mesh), config.max_deviation_m, spacing_m);
  }
  if (facts) *facts = {full_triangles, result.mesh.triangles.size(), result.deviation_m};
  return result.mesh;
}

}  // namespace roomradar
