// teapot.hpp: the Utah teapot from its published Bezier patches, as a built-in virtual object.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Builds the Utah teapot: stands on z = 0, body axis along z, spout along +x, handle along -x, +z up.
/// Triangles are counter-clockwise from outside, with smooth vertex normals. Adjacent patches share their
/// vertices.
///
/// @param tessellation  number n of segments along each side of each of the 32 patches, 1 to 256. For n >= 2,
///                      the mesh has 64 n^2 - 8 n triangles (n = 10: 6,320)
/// @param height_m      height from the base to the top of the knob, > 0. The length is 2.04 and the width
///                      1.27 times the height
/// @throws Error if an argument is out of range
/// Source: Martin Newell, University of Utah, 1975; control points as published in F. Crow, The Origins of
/// the Teapot, IEEE Computer Graphics and Applications 7(1), 1987.
Mesh utah_teapot(int tessellation, double height_m);

}  // namespace roomradar
