// draw.hpp: draw the virtual objects as a camera sees them.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "app/render/object_layer.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// A virtual object: drawn with its mesh's normals and colours where it has them, else flat and in `colour`.
struct DrawnObject {
  MeshInstance instance;
  Rgb colour{198, 120, 72};
  bool is_closed = false;  ///< true: its inside is never seen, and faces that are turned away are left out
};

struct Lighting {
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d to_key_light_world{0.35, -0.25, 0.9};  ///< towards a lamp under the ceiling; any length
  float exposure = 1.0F;                                 ///< brightness of the room, 1 = a lit room
  float gloss = 0.35F;                                   ///< strength of the highlight: 0 clay .. 1 glazed
};

class ObjectDrawer {
 public:
  explicit ObjectDrawer(GlContext& context);
  ObjectDrawer(const ObjectDrawer&) = delete;
  ObjectDrawer& operator=(const ObjectDrawer&) = delete;
  ~ObjectDrawer();

  /// Begins to draw the objects into `layer`, whose rectangle is just large enough for them; an empty
  /// rectangle if none is in view. 2 x 2 samples a pixel, or one where the rectangle has more than 80,000
  /// pixels. Near plane 0.05 m, no far end; the depth step is 6e-8 of the depth. Objects with a null mesh are
  /// left out. Rectangle and samples are set at once; colour and depth come with finish(), until when the
  /// renderer goes on beside the caller. Reuses the layer's allocations.
  void begin(std::span<const DrawnObject> objects, const Intrinsics& camera,
             const Eigen::Isometry3d& T_world_camera, const Lighting& lighting, ObjectLayer& layer);
  /// Colour and depth of what was begun last, with the same layer.
  void finish(ObjectLayer& layer);
  /// Both, with nothing beside.
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
