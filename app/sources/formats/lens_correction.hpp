// lens_correction.hpp: resamples images of a real lens to an ideal pinhole camera.
#pragma once
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// Rational lens distortion, with OpenCV's coefficients k1 k2 p1 p2 k3 k4 k5 k6. All 0 means a pinhole
/// camera. k4 = k5 = k6 = 0 is the model of Lens. Source: Claus and Fitzgibbon, CVPR 2005; OpenCV, calib3d.
struct RationalLens {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0, k4 = 0.0, k5 = 0.0, k6 = 0.0;
  friend bool operator==(const RationalLens&, const RationalLens&) = default;
};

/// Distorts the normalised point `p`.
PlanePoint<double> distorted(const PlanePoint<double>& p, const RationalLens& lens);

/// Resampling tables of one camera, for images of one size.
class LensCorrection {
 public:
  /// @param real  the camera with its lens; its intrinsics must be valid
  /// Throws Error naming `where` if a coefficient is not finite or the distortion is not monotonic near the
  /// image centre.
  LensCorrection(const Intrinsics& real, const RationalLens& lens, const char* where);

  /// Returns the pinhole camera of the corrected images. Its size and principal point are those of the real
  /// camera. Its focal lengths are reduced until the image contains the midpoints of all four edges of the
  /// real image, but never below half of the real camera's.
  [[nodiscard]] const Intrinsics& ideal() const { return ideal_; }

  /// Resamples by nearest neighbour. Pixels outside the real image are 0. The image must have the camera's
  /// size.
  void correct(DepthImage& depth_m);
  /// Resamples bilinearly. Pixels outside the real image are black.
  void correct(ColourImage& colour);

 private:
  Intrinsics ideal_;
  Image<float> real_x_, real_y_;  // position in the real image; -10 outside
  DepthImage real_depth_m_;
  ColourImage real_colour_;
};

}  // namespace roomradar
