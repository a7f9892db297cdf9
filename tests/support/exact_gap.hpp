// exact_gap.hpp: the distances along z over which two triangles touch or cross.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

namespace roomradar {

/// Wide enough that the reference loses no bits of a double in its own sums.
using Exact = long double;
using ExactPoint = Eigen::Matrix<Exact, 3, 1>;  ///< x and y across the direction, z along it
using ExactTriangle = std::array<ExactPoint, 3>;

/// Closed interval: the triangles touch at both ends.
struct TravelSpan {
  double from_m = 0.0;
  double to_m = 0.0;
};

/// Returns the distances t at which `object`, moved by t along z, has a point in common with `scene`; nullopt
/// if their outlines across z do not overlap. The gap between the two is linear in x and y over the convex
/// patch where the outlines overlap. It is therefore least and greatest at the patch's corners: a vertex of
/// one above or below the other's face, or two crossing edges. An edge-on triangle counts as its edges.
/// Outlines that overlap by less than 1e-12 of their size count as overlapping.
std::optional<TravelSpan> exact_gap(const ExactTriangle& object, const ExactTriangle& scene);

}  // namespace roomradar
