// draw.hpp: renders virtual objects with OpenGL.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "app/render/object_layer.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// A virtual object to render. Mesh normals and colours are used if present, else flat shading and `colour`.
struct DrawnObject {
  MeshInstance instance;
  Rgb colour{198, 120, 72};
  bool is_closed = false;  ///< true: its inside is never visible, so back faces are culled
};

struct Lighting {
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d to_key_light_world{0.35, -0.25, 0.9};  ///< towards a lamp under the ceiling; any length
  float exposure = 1.0F;                                 ///< brightness of the room, 1 = a lit room
  float gloss = 0.35F;                                   ///< strength of the highlight: 0 clay, 1 glazed
};

class ObjectDrawer {
 public:
  explicit ObjectDrawer(GlContext& context);
  ObjectDrawer(const ObjectDrawer&) = delete;
  ObjectDrawer& operator=(const ObjectDrawer&) = delete;
  ~ObjectDrawer();

  /// Starts rendering the objects into `layer`, whose rectangle is just large enough for them, empty if none
  /// is in view. Uses 2 x 2 samples per pixel, or one if the rectangle has more than 80,000 pixels. Near
  /// plane 0.05 m, no far plane; the depth resolution is 6e-8 of the depth. Objects with a null mesh are
  /// skipped. Rectangle and samples are set at once; colour and depth are set by finish(), and the GPU
  /// renders meanwhile. Reuses the layer's memory.
  void begin(std::span<const DrawnObject> objects, const Intrinsics& camera,
             const Eigen::Isometry3d& T_world_camera, const Lighting& lighting, ObjectLayer& layer);
  /// Fills colour and depth of the layer passed to the last begin().
  void finish(ObjectLayer& layer);
  /// Calls begin() and finish().
  void draw(std::span<const DrawnObject> objects, const Intrinsics& camera,
            const Eigen::Isometry3d& T_world_camera, const Lighting& lighting, ObjectLayer& layer) {
    begin(objects, camera, T_world_camera, lighting, layer);
    finish(layer);
  }

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
