// exact_gap.hpp: at which travels along z do two triangles have a point in common?
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

namespace roomradar {

/// Wide enough that nothing a double says of a triangle is lost in the judge's own sums.
using Exact = long double;
using ExactPoint = Eigen::Matrix<Exact, 3, 1>;  ///< x, y across the direction, z along it
using ExactTriangle = std::array<ExactPoint, 3>;

/// Closed: at both ends they touch.
struct TravelSpan {
  double from_m = 0.0;
  double to_m = 0.0;
};

/// The travels t at which `object`, moved by t along z, has a point in common with `scene`; nothing if their
/// outlines across z do not meet. The gap between the two is affine over the convex patch that their outlines
/// share (linear in x and y), so it is least and greatest at the patch's corners: a corner of one over or
/// under the other's face, or two edges that cross. An edge-on triangle is its edges. Outlines that meet by
/// less than 1e-12 of their size count as meeting.
std::optional<TravelSpan> exact_gap(const ExactTriangle& object, const ExactTriangle& scene);

}  // namespace roomradar
