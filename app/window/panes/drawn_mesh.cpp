// drawn_mesh.cpp: uploads meshes and their textures to the window's renderer.
#include "app/window/panes/drawn_mesh.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace roomradar {

DrawnMesh::DrawnMesh() {
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(4, buffers_.data());
}

DrawnMesh::~DrawnMesh() {
  glDeleteBuffers(4, buffers_.data());
  glDeleteTextures(1, &texture_);
  glDeleteVertexArrays(1, &vertex_array_);
}

void DrawnMesh::upload(const Mesh& mesh, bool changes_often) {
  const auto fill = [&](GLenum target, unsigned buffer, const auto& values) {
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                 changes_often ? GL_STREAM_DRAW : GL_STATIC_DRAW);
  };
  origin_ = mesh.origin;
  has_colours_ = mesh.colours.size() == mesh.vertices.size() && !mesh.colours.empty();
  index_count_ = static_cast<int>(mesh.triangles.size() * 3);
  glBindVertexArray(vertex_array_);
  fill(GL_ARRAY_BUFFER, buffers_[0], mesh.vertices);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  if (has_colours_) {
    fill(GL_ARRAY_BUFFER, buffers_[1], mesh.colours);
    glVertexAttribPointer(1, 3, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
    glEnableVertexAttribArray(1);
  } else {
    glDisableVertexAttribArray(1);
  }
  fill(GL_ELEMENT_ARRAY_BUFFER, buffers_[2], mesh.triangles);
  glBindVertexArray(0);
}

void DrawnMesh::upload_texture(const std::vector<Eigen::Vector2f>& points, const ColourImage& texture) {
  glDeleteTextures(1, &texture_);
  texture_ = 0;
  glBindVertexArray(vertex_array_);
  glDisableVertexAttribArray(2);
  if (!points.empty() && !texture.empty()) {
    constexpr int kLevels = 4;  // coarser ones would mix charts
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[3]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(points[0])), points.data(),
                 GL_STATIC_DRAW);
    glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(2);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, texture.width, texture.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 texture.pixels.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kLevels - 1);
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  glBindVertexArray(0);
}

}  // namespace roomradar
