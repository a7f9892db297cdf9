// texture_view.hpp: a colour picture of the room with known pose, and a measure of how well it shows a point.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "mapping/texture/subsampled_picture.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Colour image of a frame, prepared for baking. Takes about 2 bytes per pixel.
struct TextureView {
  Intrinsics camera;  ///< colour camera
  SubsampledPicture colour;
  ColourImage low;  ///< low-pass filtered picture, an eighth of its width and height
  /// Max depth, mm, at which the picture shows the mesh, in an image of half the picture's size. 0: the
  /// picture does not show the mesh, since no triangle projects there or the frame measured another depth.
  Image<std::uint16_t> shown_mm;
  Eigen::Isometry3f T_camera_local =
      Eigen::Isometry3f::Identity();               ///< maps points relative to the mesh's origin
  float sharpness = 1.0F;                          ///< 0..1
  std::array<float, 3> gain = {1.0F, 1.0F, 1.0F};  ///< per channel; equalises the exposure
};

/// Prepares a frame's colour image for baking. Leaves out pixels whose measured depth differs from the
/// mesh's, since they show a moved object, and the neighbours of these pixels. Also leaves out pixels next to
/// the silhouette of a nearer surface.
/// @param T_world_camera    pose of the frame's depth camera, in the world frame of the mesh
/// @param image_speed_pxps  see ViewCandidate
TextureView make_texture_view(const Frame& frame, const Eigen::Isometry3d& T_world_camera, const Mesh& mesh,
                              double image_speed_pxps);

/// Returns the image coordinates of a point in front of the camera.
inline Eigen::Vector2f pixel_of(const Intrinsics& camera, const Eigen::Vector3f& p_camera) {
  return {static_cast<float>(camera.fx_px) * p_camera.x() / p_camera.z() + static_cast<float>(camera.cx_px),
          static_cast<float>(camera.fy_px) * p_camera.y() / p_camera.z() + static_cast<float>(camera.cy_px)};
}

/// A point of the mesh's surface as a view shows it.
struct ShownPoint {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< in TextureView::colour
  /// Pixels of the picture per metre of the surface, in the direction of greatest foreshortening. 0: the view
  /// does not show the point.
  float px_per_m = 0.0F;
  float score = 0.0F;  ///< px_per_m times the view's sharpness; less near the picture's border
};

/// @param p_local  relative to the mesh's origin, m
/// @param normal   unit
ShownPoint shown(const TextureView& view, const Eigen::Vector3f& p_local, const Eigen::Vector3f& normal);

/// Returns the colour at a pixel of TextureView::colour, interpolated and multiplied by the gain, 0..255.
/// low_colour_at() samples the low-pass filtered picture.
Eigen::Array3f colour_at(const TextureView& view, const Eigen::Vector2f& pixel);
Eigen::Array3f low_colour_at(const TextureView& view, const Eigen::Vector2f& pixel);

/// Returns true if a channel is overexposed at the pixel, so that its colour is not known.
bool is_overexposed(const TextureView& view, const Eigen::Vector2f& pixel);

}  // namespace roomradar
