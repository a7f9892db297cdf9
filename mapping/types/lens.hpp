// lens.hpp: lens distortion and its inverse.
#pragma once
#include <cmath>

namespace roomradar {

/// Radial and tangential distortion with OpenCV's coefficients k1 k2 p1 p2 k3. All 0 means a pinhole camera.
/// Source: Brown, Decentering distortion of lenses, Photogrammetric Engineering 1966.
struct Lens {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
  friend bool operator==(const Lens&, const Lens&) = default;
};

/// Point of an image plane, x right, y down. Unless stated otherwise, in normalised image coordinates: on the
/// plane z = 1, without unit.
template <typename Scalar>
struct PlanePoint {
  Scalar x{}, y{};
};

/// Distorts the normalised point `p`. The coefficients are separate parameters rather than a Lens, since
/// Scalar and Coefficient may be automatic-differentiation types.
template <typename Scalar, typename Coefficient>
PlanePoint<Scalar> distorted(const PlanePoint<Scalar>& p, const Coefficient& k1, const Coefficient& k2,
                             const Coefficient& p1, const Coefficient& p2, const Coefficient& k3) {
  const Scalar r2 = p.x * p.x + p.y * p.y;
  const Scalar radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {p.x * radial + 2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x),
          p.y * radial + p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y};
}
inline PlanePoint<double> distorted(const PlanePoint<double>& p, const Lens& lens) {
  return distorted(p, lens.k1, lens.k2, lens.p1, lens.p2, lens.k3);
}

/// Inverts distorted() by a fixed number of Newton steps. Accurate to 1e-12 for lenses that move no image
/// point by more than a tenth of the point's distance from the centre.
template <typename Scalar, typename Coefficient>
PlanePoint<Scalar> undistorted(const PlanePoint<Scalar>& p_distorted, const Coefficient& k1,
                               const Coefficient& k2, const Coefficient& p1, const Coefficient& p2,
                               const Coefficient& k3) {
  constexpr int kSteps = 6;
  PlanePoint<Scalar> p = p_distorted;
  for (int step = 0; step < kSteps; ++step) {
    const PlanePoint<Scalar> there = distorted(p, k1, k2, p1, p2, k3);
    const Scalar missing_x = p_distorted.x - there.x, missing_y = p_distorted.y - there.y;
    const Scalar r2 = p.x * p.x + p.y * p.y;
    const Scalar radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const Scalar growth = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // 2 d(radial)/d(r2)
    const Scalar xx = radial + p.x * p.x * growth + 2.0 * p1 * p.y + 6.0 * p2 * p.x;
    const Scalar xy = p.x * p.y * growth + 2.0 * p1 * p.x + 2.0 * p2 * p.y;
    const Scalar yy = radial + p.y * p.y * growth + 6.0 * p1 * p.y + 2.0 * p2 * p.x;
    const Scalar determinant = xx * yy - xy * xy;
    // At this point, the model folds the image. No real lens does so, but a file may contain such
    // coefficients.
    if (!(determinant > Scalar(0.1))) {
      p = {p.x + missing_x, p.y + missing_y};
      continue;
    }
    p = {p.x + (yy * missing_x - xy * missing_y) / determinant,
         p.y + (xx * missing_y - xy * missing_x) / determinant};
  }
  return p;
}
inline PlanePoint<double> undistorted(const PlanePoint<double>& p_distorted, const Lens& lens) {
  return undistorted(p_distorted, lens.k1, lens.k2, lens.p1, lens.p2, lens.k3);
}

}  // namespace roomradar
