// contact_pixels.hpp: pixels along an object's contact with its support, where the support must not occlude
// the object.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Level planes through the lowest points of objects, as seen from a camera.
struct Feet {
  struct Plane {
    /// Upwards, unit, in the camera's frame.
    Eigen::Vector3f up_camera = Eigen::Vector3f::UnitY();
    /// Height of the camera above the plane.
    float camera_m = 0.0F;
  };
  Intrinsics camera{};
  std::vector<Plane> planes;
  /// Points of an object up to this height above its lowest point (foot) belong to its contact.
  float height_m = 0.012F;
};

/// Tolerance for errors of real depth: a constant term, and a term that increases with the square of the
/// distance, 1/m.
struct DepthTolerance {
  float constant_m = 0.0F, per_m2 = 0.0F;
};

/// Values of the contact mask. Both mark a point of an object within Feet::height_m of its lowest point
/// (foot). The real surface in this pixel is the object's support (kOnSupport) or another surface (kAtFoot).
inline constexpr std::uint8_t kAtFoot = 128, kOnSupport = 255;

/// Marks the pixels that show a point of an object within feet.height_m of its foot. The mark is kOnSupport
/// if the height of the real surface equals that of the foot within the tolerance plus 6 mm, since a surface
/// at this height is the object's support. Otherwise the mark is kAtFoot.
/// @param rect          rectangle of the image
/// @param real_depth_m  depth of real surfaces in the whole image
/// @param object_m      depth of the objects in `rect`
/// @param[out] contact  mask with the size of `rect`; 0 in pixels without contact
void find_contacts(const Feet& feet, const PixelRect& rect, const DepthImage& real_depth_m,
                   const Image<float>& object_m, const DepthTolerance& tolerance, MaskImage& contact);

/// Averages `hidden` over 3 x 3 pixels with more weight at the centre. For neighbours that no object covers,
/// the pixel's own value is used, since their object depth is extrapolated. Sets pixels of kOnSupport to 0.
/// Also sets pixels of kAtFoot to 0 if they are more visible than hidden, so that a nearby occluder does not
/// blur over the contact.
void soften(const Image<float>& hidden, const MaskImage& covered, const MaskImage& contact,
            Image<float>& softened);

}  // namespace roomradar
