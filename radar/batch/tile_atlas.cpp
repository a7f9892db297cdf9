// tile_atlas.cpp: a float texture drawn into by minimum blending.
#include "radar/batch/tile_atlas.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <limits>

namespace roomradar {

TileAtlas::TileAtlas(GlContext& /*context*/) { glCreateFramebuffers(1, &framebuffer_); }

TileAtlas::~TileAtlas() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
}

bool TileAtlas::resize(int columns, int rows, int tile_px) {
  forget_gl_errors();
  glDeleteTextures(1, &texture_);
  glCreateTextures(GL_TEXTURE_2D, 1, &texture_);
  glTextureStorage2D(texture_, 1, GL_RGBA32F, columns * tile_px, rows * tile_px);
  glTextureParameteri(texture_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, texture_, 0);
  const bool is_given =
      glGetError() == GL_NO_ERROR &&
      glCheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  columns_ = is_given ? columns : 0;
  rows_ = is_given ? rows : 0;
  tile_px_ = is_given ? tile_px : 0;
  return is_given;
}

std::array<int, 2> TileAtlas::corner_px(std::size_t tile) const {
  const auto columns = static_cast<std::size_t>(columns_);
  return {static_cast<int>(tile % columns) * tile_px_, static_cast<int>(tile / columns) * tile_px_};
}

void TileAtlas::bind(bool least) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_px(), height_px());
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  least ? glEnable(GL_BLEND) : glDisable(GL_BLEND);
  glBlendEquation(least ? GL_MIN : GL_FUNC_ADD);
}

void TileAtlas::unbind() {
  glDisable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void TileAtlas::clear(std::size_t tiles, float value) const {
  if (tiles == 0 || columns_ == 0) return;
  const auto columns = static_cast<std::size_t>(columns_);
  const int rows = static_cast<int>((tiles + columns - 1) / columns);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, rows > 1 ? width_px() : static_cast<int>(tiles) * tile_px_, rows * tile_px_);
  const float values[4] = {value, value, value, value};
  glClearBufferfv(GL_COLOR, 0, values);
  glDisable(GL_SCISSOR_TEST);
}

void TileAtlas::read(int x_px, int y_px, int width_px, int height_px, float* out) const {
  // In blocks of rows whose byte count fits GLsizei.
  const GLsizei row_bytes = static_cast<GLsizei>(4 * sizeof(float)) * width_px;
  const int rows_at_once = std::max(std::numeric_limits<GLsizei>::max() / std::max(row_bytes, 1), 1);
  for (int row = 0; row < height_px; row += rows_at_once) {
    const int rows = std::min(rows_at_once, height_px - row);
    glGetTextureSubImage(texture_, 0, x_px, y_px + row, 0, width_px, rows, 1, GL_RGBA, GL_FLOAT,
                         row_bytes * rows, out + static_cast<std::size_t>(row) * 4U * width_px);
  }
}

}  // namespace roomradar
