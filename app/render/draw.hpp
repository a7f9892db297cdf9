// draw.hpp: renders virtual objects with OpenGL.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "app/models/model.hpp"
#include "app/render/object_layer.hpp"
#include "app/render/room_light.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// A texture with its mipmaps. Texture coordinate (0, 0) is the image's top left corner, (1, 1) its bottom
/// right corner.
class GpuTexture {
 public:
  /// Throws Error if GPU memory is exhausted. Textures of up to 16,384 x 16,384 px are supported by every
  /// OpenGL 4.5 renderer.
  GpuTexture(GlContext& context, const Texture& texture);
  ~GpuTexture();
  GpuTexture(const GpuTexture&) = delete;
  GpuTexture& operator=(const GpuTexture&) = delete;

  /// Returns the texture's GL name.
  [[nodiscard]] unsigned name() const { return name_; }
  /// Returns the alpha cutoff, 0..1, below which a pixel is not drawn; 0 for an opaque texture.
  [[nodiscard]] float least_opacity() const { return least_opacity_; }

 private:
  unsigned name_ = 0;
  float least_opacity_ = 0.0F;
};

/// Triangles of an object that share one texture or have none.
struct DrawnPart {
  const GpuMesh* mesh = nullptr;        ///< must have texture coordinates if `texture` is set
  const GpuTexture* texture = nullptr;  ///< multiplies the vertex colours; null: vertex colours only
};

/// A virtual object to render. Meshes without normals are shaded flat. Meshes without vertex colours are
/// drawn in `colour`, or in white under a texture.
struct DrawnObject {
  MeshInstance instance;
  Rgb colour{198, 120, 72};
  /// True if the mesh is closed: its inside is never visible, so back faces are culled.
  bool is_closed = false;
  /// Parts that are drawn at the instance's pose instead of the instance's mesh. Their meshes must have the
  /// Mesh::origin of the instance's mesh. Empty: the instance's mesh is drawn.
  std::span<const DrawnPart> parts{};
  /// Light at the object; null: that of Lighting.
  const SplitLight* light = nullptr;
};

/// Light of objects without DrawnObject::light. The default is that of a room with white ceiling lamps.
struct Lighting {
  Eigen::Vector3d up_world = Eigen::Vector3d::UnitZ();
  /// Direction towards the main light, such as a ceiling lamp; any length > 0.
  Eigen::Vector3d to_key_light_world{0.35, -0.25, 0.9};
  /// Factor on all light; 1 for a lit room.
  float exposure = 1.0F;
  /// Strength of the specular highlight, of all objects. 0 looks like clay, 1 like glazed ceramics.
  float gloss = 0.1F;
};

/// Renders virtual objects into an ObjectLayer.
class ObjectDrawer {
 public:
  explicit ObjectDrawer(GlContext& context);
  ObjectDrawer(const ObjectDrawer&) = delete;
  ObjectDrawer& operator=(const ObjectDrawer&) = delete;
  ~ObjectDrawer();

  /// Starts rendering the objects into `layer`. Sets layer.rect to the smallest rectangle that contains the
  /// objects, empty if none is in view. Sets layer.samples to 2, or to 1 if the rectangle has more than
  /// 80,000 pixels or twice its size exceeds the max texture size. The GPU renders in parallel to the CPU.
  /// finish() then sets colour and depth. The near plane is at 0.05 m. There is no far plane. The depth
  /// resolution is 6e-8 of the depth. Objects with a null mesh are skipped. Reuses the layer's memory.
  void begin(std::span<const DrawnObject> objects, const Intrinsics& camera,
             const Eigen::Isometry3d& T_world_camera, const Lighting& lighting, ObjectLayer& layer);
  /// Waits for the GPU, and sets colour and depth of `layer`, which must be the one passed to the last
  /// begin().
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
