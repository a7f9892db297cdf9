// object_model.cpp: makes the model of a mesh.
#include "app/objects/object_model.hpp"

#include <cstdint>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include "app/models/model.hpp"
#include "app/objects/object_lod.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns a model of the given triangles, in the given order, with the vertices that they use and all
/// attributes of these vertices. The result has neither parts nor textures nor notes.
/// @param triangles  indices into model.mesh.triangles
Model triangles_alone(const Model& model, std::span<const std::uint32_t> triangles) {
  const Mesh& mesh = model.mesh;
  Model alone;
  alone.mesh.origin = mesh.origin;
  alone.mesh.triangles.reserve(triangles.size());
  std::unordered_map<std::uint32_t, std::uint32_t> name;
  for (const std::uint32_t t : triangles) {
    Triangle triangle = mesh.triangles[t];
    for (std::uint32_t& vertex : triangle) {
      const auto [known, is_new] =
          name.try_emplace(vertex, static_cast<std::uint32_t>(alone.mesh.vertices.size()));
      if (is_new) {
        alone.mesh.vertices.push_back(mesh.vertices[vertex]);
        if (!mesh.normals.empty()) alone.mesh.normals.push_back(mesh.normals[vertex]);
        if (!mesh.colours.empty()) alone.mesh.colours.push_back(mesh.colours[vertex]);
        if (!model.texture_points.empty()) alone.texture_points.push_back(model.texture_points[vertex]);
      }
      vertex = known->second;
    }
    alone.mesh.triangles.push_back(triangle);
  }
  return alone;
}

std::vector<Eigen::Vector3d> corners_of(const GpuMesh& mesh) {
  std::vector<bool> is_corner(mesh.vertices().size());
  for (const Triangle& triangle : mesh.triangles())
    for (const std::uint32_t vertex : triangle) is_corner[vertex] = true;
  std::vector<Eigen::Vector3d> corners;
  for (std::size_t vertex = 0; vertex < is_corner.size(); ++vertex)
    if (is_corner[vertex]) corners.push_back(mesh.origin() + mesh.vertices()[vertex].cast<double>());
  return corners;
}

}  // namespace

ObjectParts object_parts_without_levels(const std::string& name, Model source) {
  ObjectParts parts;
  parts.source = std::move(source);
  const Mesh& mesh = parts.source.mesh;
  parts.touched.build_by_place(mesh);
  if (parts.touched.empty()) throw Error(name + ": has no triangles; a virtual object is a surface");
  parts.mass = mass_properties(mesh, parts.touched.is_closed());
  parts.surface = spread_points(mesh);
  return parts;
}

ObjectParts object_parts(const std::string& name, Model source) {
  ObjectParts parts = object_parts_without_levels(name, std::move(source));
  parts.levels = levels_of_detail(parts.source);
  return parts;
}

ObjectParts object_parts(const std::string& name, Mesh mesh) {
  return object_parts(name, Model{.mesh = std::move(mesh)});
}

ObjectModel::ObjectModel(GlContext& context, ObjectParts made)
    : source(std::move(made.source)),
      shape(context),
      mass(made.mass),
      surface(std::move(made.surface)),
      context_(context) {
  shape.set(source.mesh, std::move(made.touched));
  corners = corners_of(shape.drawn);
  middle = shape.drawn.bounds().center();
  upload_textures();
  parts = upload_parts(source);
  if (made.levels)
    upload_levels(*made.levels);
  else
    computed_ = std::async(std::launch::async, [this] { return levels_of_detail(source); });
}

std::span<const DrawnLevel> ObjectModel::levels() const {
  if (computed_.valid()) upload_levels(computed_.get());
  return levels_;
}

void ObjectModel::upload_levels(const std::vector<LevelOfDetail>& levels) const {
  for (const LevelOfDetail& level : levels) {
    DrawnLevel drawn{level.deviation_m, std::make_unique<GpuMesh>(context_)};
    drawn.mesh->upload(level.mesh, MeshUsage::kStatic);
    if (!level.parts.empty())
      drawn.parts =
          upload_parts({.mesh = level.mesh, .texture_points = level.texture_points, .parts = level.parts});
    levels_.push_back(std::move(drawn));
  }
}

void ObjectModel::upload_textures() {
  for (const Texture& texture : source.textures) {
    textures.push_back(std::make_unique<GpuTexture>(context_, texture));
    is_opaque = is_opaque && texture.opacity.empty();
  }
}

std::vector<DrawnPart> ObjectModel::upload_parts(const Model& of) const {
  std::vector<DrawnPart> drawn;
  for (const ModelPart& part : of.parts) {
    if (part.triangle_count == 0) continue;
    std::vector<std::uint32_t> triangles(part.triangle_count);
    std::iota(triangles.begin(), triangles.end(), part.first_triangle);
    const Model alone = triangles_alone(of, triangles);
    part_meshes_.push_back(std::make_unique<GpuMesh>(context_));
    GpuMesh& mesh = *part_meshes_.back();
    mesh.upload(alone.mesh, MeshUsage::kStatic);
    const bool is_textured = part.texture != kNoTexture;
    if (is_textured) mesh.upload_texture_points(alone.texture_points);
    drawn.push_back({&mesh, is_textured ? textures[static_cast<std::size_t>(part.texture)].get() : nullptr});
  }
  return drawn;
}

bool is_model_of(const ObjectModel& model, const Model& source) {
  const Model& own = model.source;
  return own.mesh.origin == source.mesh.origin && own.mesh.vertices == source.mesh.vertices &&
         own.mesh.triangles == source.mesh.triangles && own.mesh.normals == source.mesh.normals &&
         own.mesh.colours == source.mesh.colours && own.texture_points == source.texture_points &&
         own.parts == source.parts && own.textures == source.textures;
}

}  // namespace roomradar
