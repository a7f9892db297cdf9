// surface.hpp: the static map's surface as triangles, placed by signed distance.
#pragma once
#include "mapping/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

struct SurfaceConfig {
  float min_weight = 0.0F;              ///< samples with less are taken as unknown
  float min_component_area_m2 = 4e-3F;  ///< connected pieces with less area are specks (about 6 x 6 cm)
  float max_deviation_m = 2e-3F;        ///< bound given to the simplification; 0 keeps every triangle
};

/// One vertex in each cell of eight neighbouring samples whose signs differ, at the mean of the zero
/// crossings on its edges; one quad across each crossed edge whose four cells have a vertex. Cells with an
/// unknown corner have none, so that holes stay open. Then specks go, and triangles are merged within
/// max_deviation_m. Vertices are in the world (mesh.origin + vertex), normals point to the free side, colours
/// are the samples'. An empty map gives an empty mesh. Throws Error if the config is out of its rules (values
/// finite and >= 0). Source: Gibson, Constrained Elastic Surface Nets, MICCAI 1998; Garland and Heckbert,
/// SIGGRAPH 1997 (simplification).
Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config = {});

}  // namespace roomradar
