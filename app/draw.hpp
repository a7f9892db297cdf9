// draw.hpp: draw the virtual objects as a camera sees them; the one file of app/ that talks to GL.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>

#include "app/object_layer.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

class GlContext;

/// A mesh on the GPU with what shading needs: positions, normals, colours. Lives as long as its context.
class DrawnMesh {
 public:
  /// Normals are computed (area-weighted) where the mesh has none; colour is used where it has no colours.
  /// Throws Error if the mesh has no triangles, an index past its vertices, or a vertex that is not finite.
  DrawnMesh(GlContext& context, const Mesh& mesh, Rgb colour = {196, 148, 92});
  DrawnMesh(DrawnMesh&&) noexcept;
  DrawnMesh& operator=(DrawnMesh&&) noexcept;
  ~DrawnMesh();

 private:
  friend class ObjectDrawer;
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

struct DrawnObject {
  const DrawnMesh* mesh = nullptr;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
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

  /// Draws the objects at 2 x 2 samples a pixel into `layer`, whose rectangle is just large enough for them; an empty
  /// rectangle if none is in view. Near plane 0.05 m, far plane behind the farthest object: the depth step at 1 m
  /// is below 1e-4 m. Reuses the layer's allocations.
  void draw(std::span<const DrawnObject> objects, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
            const Lighting& lighting, ObjectLayer& layer);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
