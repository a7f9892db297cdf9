// gpu_mesh.cpp: buffers filled once or every frame, and drawn chunk by chunk.
#include "radar/gl/gpu_mesh.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <string>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

// Triangles per chunk. Static mesh with 1 cm cells: 1,024 triangles are a patch of about 25 cm, the size of a
// thrown object. Streamed mesh: a run is part of an image row, or a few rows.
constexpr std::uint32_t kStaticChunkTriangles = 1024;
constexpr std::uint32_t kStreamedChunkTriangles = 512;

enum Buffer : GLuint { kPositions, kNormals, kColours, kIndices };
constexpr GLuint kTexturePoints = 3;  // attribute and binding

/// Returns true if the box is wholly outside one of the clip planes. Conservative: a box near a corner may
/// count as inside.
bool is_outside(const Eigen::AlignedBox3d& box, const Eigen::Matrix4d& clip_from_local) {
  const Eigen::Vector3d centre = box.center();
  const Eigen::Vector3d half = 0.5 * box.sizes();
  const Eigen::RowVector4d w = clip_from_local.row(3);
  const Eigen::RowVector4d x = clip_from_local.row(0);
  const Eigen::RowVector4d y = clip_from_local.row(1);
  const Eigen::RowVector4d z = clip_from_local.row(2);
  const Eigen::RowVector4d planes[6] = {w + x, w - x, w + y, w - y, z, w - z};  // >= 0 inside
  for (const Eigen::RowVector4d& plane : planes) {
    const Eigen::RowVector3d n = plane.head<3>();
    if (n.dot(centre) + plane[3] + n.cwiseAbs().dot(half) < 0.0) return true;
  }
  return false;
}

void refuse(const std::string& fault) { throw Error("mesh refused: " + fault); }

void require_uploadable(const Mesh& mesh) {
  if (!mesh.origin.allFinite()) refuse("its origin is not finite");
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    refuse(std::to_string(mesh.normals.size()) + " normals for " + std::to_string(mesh.vertices.size()) +
           " vertices; give one each or none");
  }
  if (!mesh.colours.empty() && mesh.colours.size() != mesh.vertices.size()) {
    refuse(std::to_string(mesh.colours.size()) + " colours for " + std::to_string(mesh.vertices.size()) +
           " vertices; give one each or none");
  }
  if (mesh.triangles.size() > std::numeric_limits<std::int32_t>::max() / 3) {
    refuse(std::to_string(mesh.triangles.size()) + " triangles; 715827882 is the most");
  }
}

void require_nothing_dropped(const Mesh& mesh, std::size_t dropped_triangles) {
  if (dropped_triangles == 0) return;
  refuse(std::to_string(dropped_triangles) + " of " + std::to_string(mesh.triangles.size()) +
         " triangles have a vertex that is not finite or not there; repair it or leave them out");
}

}  // namespace

GpuMesh::GpuMesh(GlContext& /*context*/) {
  glCreateVertexArrays(1, &vertex_array_);
  glCreateBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  glVertexArrayVertexBuffer(vertex_array_, kPositions, buffers_[kPositions], 0, sizeof(Eigen::Vector3f));
  glVertexArrayVertexBuffer(vertex_array_, kNormals, buffers_[kNormals], 0, sizeof(Eigen::Vector3f));
  glVertexArrayVertexBuffer(vertex_array_, kColours, buffers_[kColours], 0, sizeof(Rgb));
  glVertexArrayElementBuffer(vertex_array_, buffers_[kIndices]);
  for (const GLuint attribute : {kPositions, kNormals, kColours}) {
    glVertexArrayAttribBinding(vertex_array_, attribute, attribute);
  }
  glVertexArrayAttribFormat(vertex_array_, kPositions, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(vertex_array_, kNormals, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(vertex_array_, kColours, 3, GL_UNSIGNED_BYTE, GL_TRUE, 0);
  glEnableVertexArrayAttrib(vertex_array_, kPositions);
}

GpuMesh::~GpuMesh() {
  glDeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  glDeleteBuffers(1, &texture_points_);  // 0 is ignored
  glDeleteVertexArrays(1, &vertex_array_);
}

void GpuMesh::upload(const Mesh& mesh, MeshUsage usage) {
  require_uploadable(mesh);
  if (usage == MeshUsage::kStatic) {
    ChunkedTriangles chunked;
    chunk_by_place(mesh, kStaticChunkTriangles, chunked);
    require_nothing_dropped(mesh, chunked.dropped_triangles);
    chunked_ = std::move(chunked);
  } else {
    chunk_in_order(mesh, kStreamedChunkTriangles, chunked_);
  }
  tree_ = nullptr;
  vertices_.assign(mesh.vertices.begin(), mesh.vertices.end());
  send(mesh, usage);
}

void GpuMesh::upload(const Mesh& mesh, MeshUsage usage, const TriangleTree& tree) {
  require_uploadable(mesh);
  if (usage == MeshUsage::kStatic) require_nothing_dropped(mesh, tree.dropped_triangles());
  if (tree.vertices().size() != mesh.vertices.size() ||
      tree.triangle_count() + tree.dropped_triangles() != mesh.triangles.size()) {
    refuse("its tree was built from another mesh");
  }
  tree_ = &tree;
  vertices_ = {};
  chunked_.triangles = {};
  chunked_.dropped_triangles = tree.dropped_triangles();
  cut_into_chunks(tree.vertices(), tree.triangles(),
                  usage == MeshUsage::kStatic ? kStaticChunkTriangles : kStreamedChunkTriangles, chunked_);
  send(mesh, usage);
}

void GpuMesh::upload_texture_points(std::span<const Eigen::Vector2f> points) {
  if (points.size() != vertices().size())
    refuse(std::to_string(points.size()) + " texture points for " + std::to_string(vertices().size()) +
           " vertices; give one each");
  forget_gl_errors();
  if (texture_points_ == 0) {
    glCreateBuffers(1, &texture_points_);
    glVertexArrayVertexBuffer(vertex_array_, kTexturePoints, texture_points_, 0, sizeof(Eigen::Vector2f));
    glVertexArrayAttribBinding(vertex_array_, kTexturePoints, kTexturePoints);
    glVertexArrayAttribFormat(vertex_array_, kTexturePoints, 2, GL_FLOAT, GL_FALSE, 0);
  }
  glEnableVertexArrayAttrib(vertex_array_, kTexturePoints);
  glNamedBufferData(texture_points_, static_cast<GLsizeiptr>(points.size_bytes()), points.data(),
                    GL_STATIC_DRAW);
  require_drawn("texture coordinates");
}

/// Uploads the CPU copy. If the renderer has no memory or is lost, the mesh is empty afterwards.
void GpuMesh::send(const Mesh& mesh, MeshUsage usage) {
  forget_gl_errors();
  chunk_boxes_.clear();
  for (const MeshChunk& chunk : chunked_.chunks) chunk_boxes_.push_back(chunk.bounds_local.cast<double>());
  chunk_tree_.build(chunk_boxes_);
  static std::atomic<std::uint64_t> uploads{0};
  revision_ = ++uploads;
  origin_ = mesh.origin;
  has_normals_ = !mesh.normals.empty();
  has_colours_ = !mesh.colours.empty();

  glDisableVertexArrayAttrib(vertex_array_, kTexturePoints);  // those of another mesh
  fill_buffer(kPositions, vertices().data(), vertices().size_bytes(), usage);
  fill_buffer(kIndices, triangles().data(), triangles().size_bytes(), usage);
  if (has_normals_) {
    fill_buffer(kNormals, mesh.normals.data(), mesh.normals.size() * sizeof(Eigen::Vector3f), usage);
    glEnableVertexArrayAttrib(vertex_array_, kNormals);
  } else {
    glDisableVertexArrayAttrib(vertex_array_, kNormals);
  }
  if (has_colours_) {
    fill_buffer(kColours, mesh.colours.data(), mesh.colours.size() * sizeof(Rgb), usage);
    glEnableVertexArrayAttrib(vertex_array_, kColours);
  } else {
    glDisableVertexArrayAttrib(vertex_array_, kColours);
  }
  try {
    require_drawn("mesh");
  } catch (const Error&) {
    tree_ = nullptr;
    vertices_ = {};
    chunked_ = {};
    chunk_tree_.build({});
    capacity_bytes_ = {};
    throw;
  }
}

void GpuMesh::fill_buffer(std::size_t which, const void* data, std::size_t size_bytes, MeshUsage usage) {
  if (size_bytes == 0) return;
  const GLenum hint = usage == MeshUsage::kStatic ? GL_STATIC_DRAW : GL_STREAM_DRAW;
  if (usage == MeshUsage::kStatic || size_bytes > capacity_bytes_[which]) {
    glNamedBufferData(buffers_[which], static_cast<GLsizeiptr>(size_bytes), data, hint);
    capacity_bytes_[which] = size_bytes;
    return;
  }
  glInvalidateBufferData(buffers_[which]);  // pending draws keep the old contents
  glNamedBufferSubData(buffers_[which], 0, static_cast<GLsizeiptr>(size_bytes), data);
}

std::size_t GpuMesh::draw(const Eigen::Matrix4d& clip_from_local) const {
  if (triangles().empty()) return 0;
  glBindVertexArray(vertex_array_);
  if (!has_normals_) glVertexAttrib3f(kNormals, 0.0F, 0.0F, 1.0F);
  if (!has_colours_) glVertexAttrib3f(kColours, 0.8F, 0.8F, 0.8F);
  std::size_t drawn = 0;
  visit_runs([&](const Eigen::AlignedBox3d& box) { return !is_outside(box, clip_from_local); },
             [&](std::uint32_t first, std::uint32_t count) {
               glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>(first * sizeof(Triangle)));
               drawn += count;
             });
  return drawn;
}

Eigen::AlignedBox3d GpuMesh::bounds() const {
  if (chunked_.bounds_local.isEmpty()) return {};
  return {chunked_.bounds_local.min().cast<double>() + origin_,
          chunked_.bounds_local.max().cast<double>() + origin_};
}

Eigen::Matrix4d clip_from_local(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world) {
  Eigen::Isometry3d T_world_local = instance.T_world_mesh;
  T_world_local.translate(instance.mesh->origin());
  return clip_from_world * T_world_local.matrix();
}

std::size_t draw_positions(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world) {
  const Eigen::Matrix4d clip = clip_from_local(instance, clip_from_world);
  const Eigen::Matrix4f clip_float = clip.cast<float>();
  glUniformMatrix4fv(0, 1, GL_FALSE, clip_float.data());
  return instance.mesh->draw(clip);
}

}  // namespace roomradar
