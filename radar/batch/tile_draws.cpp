// tile_draws.cpp: sorts by mesh and run; one item per instance, one call per mesh.
#include "radar/batch/tile_draws.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace roomradar {
namespace {

enum Buffer : std::size_t { kItems, kCommands };
constexpr GLuint kPositionBinding = 0, kItemBinding = 1;

}  // namespace

TileQuery tile_query(const RadarOutline& outline, double distance_m, double tolerance_m,
                     std::array<int, 2> object_corner_px, std::array<int, 2> scene_corner_px) {
  TileQuery tile;
  tile.corners_px = {object_corner_px[0], object_corner_px[1], scene_corner_px[0], scene_corner_px[1]};
  tile.width_px = outline.width_px;
  tile.height_px = outline.height_px;
  tile.touching_m = static_cast<float>(touching_m(outline, distance_m));
  tile.far_m = static_cast<float>(distance_m) + 2.0F * tile.touching_m;
  tile.tolerance_m = static_cast<float>(std::min(tolerance_m, outline.length_m));
  tile.length_m = static_cast<float>(outline.length_m);
  return tile;
}

TileDraws::TileDraws(GlContext& /*context*/) {
  static_assert(sizeof(Item) == 112 && offsetof(Item, query) == 48, "laid out as the attributes below");
  glCreateVertexArrays(1, &vertex_array_);
  glCreateBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  glEnableVertexArrayAttrib(vertex_array_, 0);
  glVertexArrayAttribFormat(vertex_array_, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vertex_array_, 0, kPositionBinding);
  for (GLuint attribute = 1; attribute <= 7; ++attribute) {
    const GLuint offset = 16 * (attribute - 1);
    glEnableVertexArrayAttrib(vertex_array_, attribute);
    if (attribute == 4 || attribute == 5) {
      glVertexArrayAttribIFormat(vertex_array_, attribute, 4, GL_INT, offset);
    } else {
      glVertexArrayAttribFormat(vertex_array_, attribute, 4, GL_FLOAT, GL_FALSE, offset);
    }
    glVertexArrayAttribBinding(vertex_array_, attribute, kItemBinding);
  }
  glVertexArrayBindingDivisor(vertex_array_, kItemBinding, 1);
  glVertexArrayVertexBuffer(vertex_array_, kItemBinding, buffers_[kItems], 0, sizeof(Item));
}

TileDraws::~TileDraws() {
  glDeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  glDeleteVertexArrays(1, &vertex_array_);
}

void TileDraws::fill_buffer(std::size_t which, const void* data, std::size_t size_bytes) {
  if (size_bytes > capacity_bytes_[which]) {
    capacity_bytes_[which] = size_bytes + size_bytes / 2;
    glNamedBufferData(buffers_[which], static_cast<GLsizeiptr>(capacity_bytes_[which]), nullptr,
                      GL_STREAM_DRAW);
  }
  glInvalidateBufferData(buffers_[which]);  // pending draws keep the old contents
  glNamedBufferSubData(buffers_[which], 0, static_cast<GLsizeiptr>(size_bytes), data);
}

void TileDraws::upload(std::span<TileDraw> draws) {
  std::sort(draws.begin(), draws.end(), [](const TileDraw& a, const TileDraw& b) {
    return std::tuple(a.mesh->revision(), a.first_triangle, a.triangle_count, a.query.query) <
           std::tuple(b.mesh->revision(), b.first_triangle, b.triangle_count, b.query.query);
  });
  items_.clear();
  commands_.clear();
  calls_.clear();
  for (const TileDraw& draw : draws) {
    const Command command{3 * draw.triangle_count, 1, 3 * draw.first_triangle, 0,
                          static_cast<std::uint32_t>(items_.size())};
    Item& item = items_.emplace_back();
    std::copy_n(draw.outline_from_local.data(), 12, item.outline_from_local.begin());
    item.query = draw.query;
    const bool is_new_mesh = calls_.empty() || calls_.back().mesh != draw.mesh;
    if (is_new_mesh) calls_.push_back({draw.mesh, commands_.size(), 0});
    const bool is_same_run = !is_new_mesh && commands_.back().first_index == command.first_index &&
                             commands_.back().index_count == command.index_count;
    if (is_same_run) {
      ++commands_.back().instance_count;
    } else {
      commands_.push_back(command);
      ++calls_.back().command_count;
    }
  }
  if (items_.empty()) return;
  fill_buffer(kItems, items_.data(), items_.size() * sizeof(Item));
  fill_buffer(kCommands, commands_.data(), commands_.size() * sizeof(Command));
}

void TileDraws::draw() const {
  glBindVertexArray(vertex_array_);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffers_[kCommands]);
  for (const Call& call : calls_) {
    glVertexArrayVertexBuffer(vertex_array_, kPositionBinding, call.mesh->position_buffer(), 0,
                              sizeof(Eigen::Vector3f));
    glVertexArrayElementBuffer(vertex_array_, call.mesh->index_buffer());
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                reinterpret_cast<const void*>(call.first_command * sizeof(Command)),
                                static_cast<GLsizei>(call.command_count), sizeof(Command));
  }
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

void TileDraws::draw_rectangles() const {
  if (items_.empty()) return;
  glBindVertexArray(vertex_array_);
  glVertexArrayVertexBuffer(vertex_array_, kPositionBinding, buffers_[kItems], 0, sizeof(Item));  // not read
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(items_.size()));
}

}  // namespace roomradar
