// object_model.hpp: data shared by all virtual objects of one mesh.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "app/models/model.hpp"
#include "app/objects/object_lod.hpp"
#include "app/objects/shape.hpp"
#include "app/physics/mass_properties.hpp"
#include "app/render/contact_shadow.hpp"
#include "app/render/draw.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// The parts of a model that need no renderer; can be made on any thread.
struct ObjectParts {
  Model source;
  TriangleTree touched;  ///< collision shape, spatially sorted
  MassProperties mass;
  SurfacePoints surface;              ///< source of its contact shadow
  std::vector<LevelOfDetail> levels;  ///< finest first
};

/// Makes the parts. Levels of a mesh with many triangles take a few tenths of a second.
/// @param name  object name for messages
/// Throws Error if the mesh has no valid triangles.
ObjectParts object_parts(const std::string& name, Model source);
/// Same, of a mesh without textures.
ObjectParts object_parts(const std::string& name, Mesh mesh);

/// A simplified mesh of an object, for rendering.
struct DrawnLevel {
  float deviation_m = 0.0F;  ///< max distance from the full mesh
  std::unique_ptr<GpuMesh> mesh;
  /// Drawn in place of the mesh, one per part of the model; empty without textures.
  std::vector<DrawnPart> parts{};
};

/// Made once per mesh and immutable afterwards; shared by any number of objects.
struct ObjectModel {
  Model source;
  Shape shape;
  std::vector<std::unique_ptr<GpuTexture>> textures;  ///< of source
  std::vector<std::unique_ptr<GpuMesh>> part_meshes;  ///< of all levels
  std::vector<DrawnPart> parts;                       ///< of the full mesh; empty without textures
  bool is_opaque = true;  ///< false: a texture has holes, through which its inside is visible
  /// Vertices used by triangles, each once, in the mesh's frame.
  std::vector<Eigen::Vector3d> corners;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< centre of its bounding box, in the mesh's frame
  MassProperties mass;
  SurfacePoints surface;           ///< source of its contact shadow
  std::vector<DrawnLevel> levels;  ///< finest first

  /// Throws Error if the mesh cannot be rendered (vertices not finite, or indices out of range).
  ObjectModel(GlContext& context, ObjectParts made);

 private:
  void upload_textures(GlContext& context);
  /// Uploads the parts of a textured model to part_meshes.
  std::vector<DrawnPart> upload_parts(GlContext& context, const Model& of);
};

/// Returns true if the ObjectModel was made from a model identical to this one.
bool is_model_of(const ObjectModel& model, const Model& source);

}  // namespace roomradar
