// occlusion.hpp: occlusion of virtual objects by real surfaces, with edges aligned to the colour image.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "app/render/object_layer.hpp"
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

struct OcclusionConfig {
  /// A real surface occludes an object only if it is nearer than the object by more than a tolerance.
  /// tolerance_m is its constant term.
  float tolerance_m = 0.006F;
  /// Increase of the tolerance with the square of the distance, as for the sensor's noise, m per m^2.
  float tolerance_per_m2 = 0.003F;
  /// Range of depth differences over which occlusion increases from 0 to 1. A range avoids hard lines at
  /// contacts.
  float softness_m = 0.004F;
  /// Max distance between an occluder's edge in the depth image and its edge in the colour image, px. 0: only
  /// depth decides occlusion.
  int edge_reach_px = 5;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const OcclusionConfig& config);

/// The rendered objects, and the planes on which they stand. Refers to both, which must outlive it.
struct RenderedObjects {
  const ObjectLayer& layer;
  const Feet& feet;  ///< planes through the objects' lowest points
};

/// Result and buffers of find_occlusion(), for a rectangle of the image.
struct Occlusion {
  /// The object layer's rectangle, enlarged by occlusion_margin_px(), within the image.
  PixelRect rect;
  /// Occluded fraction of each pixel. 0: object fully visible; 1: fully occluded.
  Image<float> hidden;
  /// Colour of the occluder, corrected for the background colour that mixes in at its edge.
  ColourImage front;

  Image<float> object_m, unsoftened;
  /// 255 in pixels that an object covers at least partly.
  MaskImage covered;
  /// Occlusion according to depth alone, 0 to 255.
  Image<std::uint8_t> by_depth;
  MaskImage edges;
  /// Result of find_contacts().
  MaskImage contact;
  /// Sums of `edges` and of by_depth over each pixel's neighbourhood.
  Image<int> near_edges, near_hidden;
  std::vector<int> column_sums;
  /// A pixel in the band around an occluder's edge.
  struct EdgePixel {
    /// Position in the rectangle.
    int x, y;
    /// Log odds of occlusion, from colour likelihoods and prior.
    float odds;
    /// Mean colour of nearby occluders.
    Rgb front;
  };
  std::vector<EdgePixel> band;
};

/// Returns the width of the margin around the layer's rectangle that find_occlusion() reads, px.
int occlusion_margin_px(const OcclusionConfig& config);

/// Computes how much real surfaces occlude the objects. The depth image determines which surface is in front,
/// but its edges are ragged and displaced by some pixels. The colour image has sharp edges, but does not tell
/// which side of an edge is in front. Each pixel within edge_reach_px of an occluder's depth edge is
/// therefore assigned to the side whose colours it matches. The colours of each side outside this band are
/// modelled by a Gaussian. The prior is the fraction of the neighbourhood that is occluded according to
/// depth. The depth edge is kept if both sides have similar colours, or if the object intersects a surface.
/// Finally, `hidden` is averaged over 3 x 3 pixels.
///
/// Contacts of objects with their support are not hidden, see find_contacts().
///
/// @param camera_image  colour image of the camera. Edges are found in it, since shadows would make an
///                      object's support look like a darker occluder
/// @param background    camera_image with the objects' shadows; may be the same image
/// @param real_depth_m  depth of real surfaces in the same camera, with the size of both images; pixels with
///                      depth 0 occlude nothing
/// @param objects       their layer must be within the image
/// @param[out] occlusion  the result
///
/// Source of the colour models and the band: Chuang et al., A Bayesian approach to digital matting, CVPR
/// 2001. Here each side has one Gaussian, and pixels are opaque.
void find_occlusion(const ColourImage& camera_image, const ColourImage& background,
                    const DepthImage& real_depth_m, const RenderedObjects& objects,
                    const OcclusionConfig& config, Occlusion& occlusion);

}  // namespace roomradar
