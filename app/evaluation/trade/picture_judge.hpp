// picture_judge.hpp: compares a composed picture with the picture made from ground truth.
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

/// Pose of an object when a picture of it was made.
struct JudgedObject {
  std::size_t object = 0;  ///< index among the judge's objects
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
};

/// A picture and the objects that it should show.
struct JudgedPicture {
  ColourImage picture;
  std::vector<JudgedObject> objects;
};

/// Sums of colour differences from the true pictures (0 to 1, mean over channels) over all pictures. Sums are
/// divided only at the end, so a picture with a mostly hidden object has little weight.
struct PictureErrors {
  double difference = 0.0;        ///< sum over all pixels
  std::size_t object_pixels = 0;  ///< pixels that objects change in the true picture
  double edge_difference = 0.0;   ///< sum over the pixels near an edge
  std::size_t edge_pixels = 0;    ///< pixels within kEdgeBand_px of an occlusion edge in the true picture

  PictureErrors& operator+=(const PictureErrors& other);
  /// Mean per object pixel; not finite if there are none.
  [[nodiscard]] double whole() const { return difference / static_cast<double>(object_pixels); }
  /// Mean per pixel near an edge; not finite if there are none.
  [[nodiscard]] double at_edges() const { return edge_difference / static_cast<double>(edge_pixels); }
};
inline constexpr int kEdgeBand_px = 4;

/// Composes true pictures from exact depth, exact poses, full meshes and new shadows. GL calls are made on
/// the constructing thread.
class PictureJudge {
 public:
  /// Throws Error as ObjectModel does.
  PictureJudge(const std::vector<Mesh>& objects);

  /// The colour camera must be the depth camera.
  /// @param frame           with colour
  /// @param true_depth_m    same size
  /// @param T_world_camera  true pose, in the objects' world
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
