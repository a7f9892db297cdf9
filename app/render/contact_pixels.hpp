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
  /// Points of an object up to this height above its foot belong to its contact.
  float height_m = 0.012F;
};

/// Error of real depth: constant term and increase with the square of the distance.
struct DepthTolerance {
  float constant_m = 0.0F, per_m2 = 0.0F;
};

/// Values of the mask of contacts: a point just above an object's foot, in front of another surface (kAtFoot)
/// or of the support itself (kOnSupport).
inline constexpr std::uint8_t kAtFoot = 128, kOnSupport = 255;

/// Marks the pixels that show a point just above an object's foot: with kOnSupport where the real surface is
/// level with the foot within the tolerance and 6 mm, else with kAtFoot. A surface at the foot's level is the
/// support, which lies below the object.
/// @param rect          rectangle of the image
/// @param real_depth_m  depth of real surfaces in the whole image
/// @param object_m      depth of the objects in `rect`
/// @param[out] contact  0 elsewhere; with the size of `rect`
void find_contacts(const Feet& feet, const PixelRect& rect, const DepthImage& real_depth_m,
                   const Image<float>& object_m, const DepthTolerance& tolerance, MaskImage& contact);

/// Averages over 3 x 3 pixels with more weight at the centre. Neighbours that no object covers have a depth
/// borrowed from elsewhere, so the pixel's own value replaces theirs. Contacts get 0. Pixels at a foot that
/// are more visible than hidden get 0, too, so that an occluder beside them does not blur over the contact.
void soften(const Image<float>& hidden, const MaskImage& covered, const MaskImage& contact,
            Image<float>& softened);

}  // namespace roomradar
