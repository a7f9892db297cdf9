// draw.hpp: renders virtual objects with OpenGL.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "app/render/gpu_texture.hpp"
#include "app/render/object_layer.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Part of an object with one texture, or with none.
struct DrawnPart {
  const GpuMesh* mesh = nullptr;        ///< with texture points, if there is a texture
  const GpuTexture* texture = nullptr;  ///< multiplies the colours; null: colours only
};

/// A virtual object to render. Mesh normals and colours are used if present, otherwise flat shading and
/// `colour`.
struct DrawnObject {
  MeshInstance instance;
  Rgb colour{198, 120, 72};
  /// True if the mesh is closed: its inside is never visible, so back faces are culled.
  bool is_closed = false;
  /// Drawn in place of the instance's mesh, at its pose; all have the same origin. Empty: that mesh is drawn.
  std::span<const DrawnPart> parts{};
};

struct Lighting {
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();
  /// Direction towards the main light, a lamp under the ceiling; any length except 0.
  Eigen::Vector3d to_key_light_world{0.35, -0.25, 0.9};
  /// Brightness of the room; 1 is a lit room.
  float exposure = 1.0F;
  /// Strength of the highlight; 0 looks like clay, 1 like glazing.
  float gloss = 0.35F;
};

/// Renders virtual objects into an ObjectLayer.
class ObjectDrawer {
 public:
  explicit ObjectDrawer(GlContext& context);
  ObjectDrawer(const ObjectDrawer&) = delete;
  ObjectDrawer& operator=(const ObjectDrawer&) = delete;
  ~ObjectDrawer();

  /// Starts rendering the objects into `layer`. Sets the layer's rectangle (the smallest that contains the
  /// objects; empty if none is in view) and number of samples. The GPU then renders in the background until
  /// finish() sets colour and depth. Uses 2 x 2 samples per pixel, or one if the rectangle has more than
  /// 80,000 pixels. The near plane is at 0.05 m; there is no far plane. The depth resolution is 6e-8 of the
  /// depth. Objects with a null mesh are skipped. Reuses the layer's memory.
  void begin(std::span<const DrawnObject> objects, const Intrinsics& camera,
             const Eigen::Isometry3d& T_world_camera, const Lighting& lighting, ObjectLayer& layer);
  /// Sets colour and depth of the layer that was passed to the last begin().
  void finish(ObjectLayer& layer);
  /// Renders the objects: calls begin() and finish().
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
