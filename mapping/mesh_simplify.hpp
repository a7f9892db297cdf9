// mesh_simplify.hpp: fewer triangles for the same surface.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Collapses edges while the quadric error stays within max_deviation_m (> 0): the root mean square distance
/// to the planes merged into a vertex, a bound in practice rather than by proof. Triangles thinner than 0.01
/// mm go. Vertices keep their places, normals and colours; unused ones go. Open borders keep their course
/// within the same error. Source: Garland and Heckbert, Surface Simplification Using Quadric Error Metrics,
/// SIGGRAPH 1997, by meshoptimizer.
Mesh simplified(const Mesh& mesh, float max_deviation_m);

/// Drops connected pieces (by shared vertices) with less area than given, and all vertices that no triangle
/// uses.
Mesh without_specks(const Mesh& mesh, float min_component_area_m2);

}  // namespace roomradar
