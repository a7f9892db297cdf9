// object_model.hpp: data shared by all virtual objects of one mesh.
#pragma once
#include <Eigen/Geometry>
#include <future>
#include <memory>
#include <optional>
#include <span>
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

/// Data of an object's model that are computed without GL, on any thread.
struct ObjectParts {
  Model source;
  TriangleTree touched;  ///< collision shape; triangles are sorted spatially
  MassProperties mass;
  SurfacePoints surface;  ///< sample points for its contact shadow
  /// Finest first. Unset: ObjectModel has another thread compute them.
  std::optional<std::vector<LevelOfDetail>> levels;
};

/// Computes an object's parts. Levels of detail take most of the time: about 5 s for a model file of 10 MB,
/// up to minutes for larger files.
/// @param name  name of the object in error messages
/// Throws Error if the mesh has no valid triangles.
ObjectParts object_parts(const std::string& name, Model source);
/// The same for a mesh without textures.
ObjectParts object_parts(const std::string& name, Mesh mesh);
/// The same without the levels of detail.
ObjectParts object_parts_without_levels(const std::string& name, Model source);

/// A simplified mesh of an object, for rendering.
struct DrawnLevel {
  float deviation_m = 0.0F;  ///< LevelOfDetail::deviation_m: two-sided distance to the full mesh
  std::unique_ptr<GpuMesh> mesh;
  /// Drawn instead of `mesh`, one per ModelPart; empty without textures.
  std::vector<DrawnPart> parts{};
};

/// Collision and render data of one model. Immutable; shared by all objects of the same model.
struct ObjectModel {
  Model source;
  Shape shape;
  std::vector<std::unique_ptr<GpuTexture>> textures;  ///< textures of `source`
  std::vector<DrawnPart> parts;                       ///< parts of the full mesh; empty without textures
  bool is_opaque = true;  ///< false: a texture has transparent areas, through which back faces are visible
  /// Vertices that triangles use, each listed once, in the mesh's frame.
  std::vector<Eigen::Vector3d> corners;
  /// Centre of the mesh's bounding box, in the mesh's frame.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  MassProperties mass;
  SurfacePoints surface;  ///< sample points for its contact shadow

  /// `context` must outlive the model. Throws Error if the mesh cannot be rendered (vertices not finite, or
  /// indices out of range).
  ObjectModel(GlContext& context, ObjectParts made);

  /// Returns the levels of detail, finest first. If made.levels was unset, the first call waits until they
  /// are computed. Call it on the thread of the GL context.
  [[nodiscard]] std::span<const DrawnLevel> levels() const;

 private:
  GlContext& context_;
  /// Meshes of all DrawnPart entries, for the full mesh and all levels.
  mutable std::vector<std::unique_ptr<GpuMesh>> part_meshes_;
  mutable std::vector<DrawnLevel> levels_;
  /// Empty once levels_ is set. Last member: its destructor waits for the thread, which reads `source`.
  mutable std::future<std::vector<LevelOfDetail>> computed_;

  void upload_textures();
  /// Uploads the meshes of a textured model's parts to part_meshes_.
  std::vector<DrawnPart> upload_parts(const Model& of) const;
  void upload_levels(const std::vector<LevelOfDetail>& levels) const;
};

/// Returns true if `model` was made from a model identical to `source`.
bool is_model_of(const ObjectModel& model, const Model& source);

}  // namespace roomradar
