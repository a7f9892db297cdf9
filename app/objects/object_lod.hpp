// object_levels.hpp: a virtual object's mesh in several finenesses, so that what is drawn is as fine as the
// pixels and not as the file.
#pragma once
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A mesh with fewer triangles, no point of which lies farther than deviation_m from the one with all, nor
/// the other way.
struct ObjectLevel {
  Mesh mesh;
  float deviation_m = 0.0F;
};

/// The levels between a mesh and about a hundred triangles, finest first; none for a mesh of less than 1,000.
/// Each may lie 1.4 times as far off as the one before; the first a 1,024th of the mesh's size. They have
/// normals that light them as the full mesh is lit (fit_normals.hpp); where that has none, it counts as lit
/// by the means of the faces round a vertex, or, where a face is turned from that mean by more than 25
/// degrees (an edge of the thing), by the face's own.
std::vector<ObjectLevel> object_levels(const Mesh& mesh);

/// Whether a level lies off by no more than so much of what a pixel shows of it.
inline bool is_fine_enough(float deviation_m, double pixel_m, double error_px) {
  return static_cast<double>(deviation_m) <= error_px * pixel_m;
}

}  // namespace roomradar
