// picture_judge.hpp: compares a composed picture with a picture composed from ground truth.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/render/compose.hpp"
#include "app/render/draw.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Pose of an object in a picture.
struct JudgedObject {
  std::size_t object = 0;  ///< index in the objects of PictureJudge
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
};

/// A composed picture, and the objects that it should show.
struct JudgedPicture {
  ColourImage picture;
  std::vector<JudgedObject> objects;
};

/// Sums of colour differences from the true pictures over all pictures. A pixel's difference is the mean over
/// channels, 0 to 1. Means are computed from these sums, so a picture with a mostly hidden object has little
/// weight.
struct PictureErrors {
  double difference = 0.0;        ///< sum over all pixels
  std::size_t object_pixels = 0;  ///< number of pixels that objects change in the true pictures
  double edge_difference = 0.0;   ///< sum over the edge pixels
  /// Number of edge pixels. These are within kEdgeBand_px of an occlusion edge in the true picture.
  std::size_t edge_pixels = 0;

  PictureErrors& operator+=(const PictureErrors& other);
  /// Returns the mean difference per object pixel; not finite if there are none.
  [[nodiscard]] double whole() const { return difference / static_cast<double>(object_pixels); }
  /// Returns the mean difference per edge pixel; not finite if there are none.
  [[nodiscard]] double at_edges() const { return edge_difference / static_cast<double>(edge_pixels); }
};
inline constexpr int kEdgeBand_px = 4;

/// Composes true pictures from exact depth, exact poses, full meshes and newly computed shadows. All calls
/// must come from the constructing thread, whose GL context is used.
class PictureJudge {
 public:
  /// Throws Error as ObjectModel does.
  PictureJudge(const std::vector<Mesh>& objects);

  /// Returns the errors of one picture. The frame's colour camera must equal its depth camera.
  /// @param frame           frame with colour
  /// @param true_depth_m    exact depth, of the frame's size
  /// @param T_world_camera  true camera pose, in the world frame of JudgedObject::T_world_object
  PictureErrors errors_of(const JudgedPicture& judged, const Frame& frame, const DepthImage& true_depth_m,
                          const Eigen::Isometry3d& T_world_camera);

 private:
  GlContext context_;
  ObjectDrawer drawer_;
  std::vector<std::unique_ptr<VirtualObject>> objects_;
  ObjectLayer layer_;
  Occlusion occlusion_;
  ColourImage right_;
  MaskImage edges_;
};

}  // namespace roomradar
