// picture_judge.hpp: how far a composed picture is from the one that the truth would give.
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

/// Where an object was when a picture was made of it.
struct JudgedObject {
  std::size_t object = 0;  ///< among the judge's
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
};

/// A picture and what it ought to show.
struct JudgedPicture {
  ColourImage picture;
  std::vector<JudgedObject> objects;
};

/// How far pictures are from the right ones: the colours' differences (0 to 1, mean of the channels), summed
/// over all of them before they are divided: where an object is all but hidden, one picture alone says
/// little.
struct PictureErrors {
  double difference = 0.0;        ///< of all pixels
  std::size_t object_pixels = 0;  ///< in which the right picture is not the camera's own
  double edge_difference = 0.0;   ///< of the pixels near an edge
  std::size_t edge_pixels = 0;    ///< within kEdgeBand_px of where the right picture begins to hide an object

  PictureErrors& operator+=(const PictureErrors& other);
  /// For each pixel of the objects; not finite where the right pictures show none.
  [[nodiscard]] double whole() const { return difference / static_cast<double>(object_pixels); }
  /// For each pixel near an edge; not finite where there is none.
  [[nodiscard]] double at_edges() const { return edge_difference / static_cast<double>(edge_pixels); }
};
inline constexpr int kEdgeBand_px = 4;

/// Composes pictures from exact depth, exact poses, objects' full meshes and fresh shadows. GL on the thread
/// that made it.
class PictureJudge {
 public:
  /// Throws Error as ObjectModel does.
  PictureJudge(const std::vector<Mesh>& objects);

  /// The colour camera must be the depth camera.
  /// @param frame           with colour
  /// @param true_depth_m    of its size
  /// @param T_world_camera  true, in the objects' world
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
