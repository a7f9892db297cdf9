// object_model.hpp: what virtual objects of one mesh share: a shape to touch and to draw, a mass, a shadow's
// points.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "app/objects/object_lod.hpp"
#include "app/objects/shape.hpp"
#include "app/physics/mass_properties.hpp"
#include "app/render/contact_shadow.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Of a model what needs no renderer, to be made on any thread.
struct ObjectParts {
  Mesh mesh;
  TriangleTree touched;  ///< built by place
  MassProperties mass;
  SurfacePoints surface;            ///< what its shadow is made of
  std::vector<ObjectLevel> levels;  ///< finest first
};

/// Takes some tenths of a second for the levels of a mesh of many triangles.
/// @param name  of the object, for messages
/// Throws Error if the mesh has no triangles that could be touched.
ObjectParts object_parts(const std::string& name, Mesh mesh);

/// A coarser mesh of an object, for the picture.
struct DrawnLevel {
  float deviation_m = 0.0F;  ///< how far it lies off the full one, at most
  std::unique_ptr<GpuMesh> mesh;
};

/// Made once for a mesh and then only read, by any number of objects.
struct ObjectModel {
  Mesh mesh;  ///< that it was made from
  Shape shape;
  /// Vertices of triangles, each once, in the mesh's frame.
  std::vector<Eigen::Vector3d> corners;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of its bounding box, in the mesh's frame
  MassProperties mass;
  SurfacePoints surface;           ///< what its shadow is made of
  std::vector<DrawnLevel> levels;  ///< finest first

  /// Throws Error if the mesh cannot be drawn (triangles with vertices that are not finite or not there).
  ObjectModel(GlContext& context, ObjectParts parts);
};

/// Whether it was made from a mesh that is the same in every number.
bool is_model_of(const ObjectModel& model, const Mesh& mesh);

}  // namespace roomradar
