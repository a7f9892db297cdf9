// surface_net.hpp: the zero crossings of signed distances as a closed net of triangles, one voxel fine.
#pragma once
#include "mapping/octree/tsdf_bricks.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A vertex for each sheet of surface that passes between eight neighbouring samples, at the mean of the
/// sheet's zero crossings on the cell's edges; a quad, as two triangles, across each crossed edge whose four
/// cells have their vertices. A cell with an unknown corner has none, so that what was not seen stays open;
/// guessed samples only complete cells: no quad crosses an edge with one, and they hardly move a vertex.
/// Vertices are in the world (mesh.origin + vertex), triangles and normals (the gradient of the trilinear
/// distance) look to the free side, colours are those of the samples, grey where they have none.
///
/// Each edge has two triangles, or one where the samples end: sheets are told apart by how the cell's faces
/// are crossed (diagonal faces part the insides), and where two cells would share a face whose four crossings
/// are one sheet in both, that face parts the outsides instead.
/// Source: Gibson, Constrained Elastic Surface Nets, MICCAI 1998 (placement); Nielson, Dual Marching Cubes,
/// IEEE Visualization 2004 (sheets); Wenger, Isosurfaces, CRC Press 2013, chapter 3 (manifold faces).
Mesh surface_net(const SampleBricks& bricks, double resolution_m);

}  // namespace roomradar
