// tile_atlas.hpp: one texture of square tiles, into which the least of four numbers a pixel is drawn.
#pragma once
#include <array>
#include <cstddef>

#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Owns a texture of four 32 bit floats a pixel and its framebuffer. Not thread safe.
class TileAtlas {
 public:
  explicit TileAtlas(GlContext& context);
  ~TileAtlas();
  TileAtlas(const TileAtlas&) = delete;
  TileAtlas& operator=(const TileAtlas&) = delete;

  /// Room for columns x rows tiles of tile_px each; what was drawn is lost. Says whether the renderer gave
  /// it; if not there is no tile.
  [[nodiscard]] bool resize(int columns, int rows, int tile_px);
  [[nodiscard]] std::size_t tile_count() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }
  [[nodiscard]] int width_px() const { return columns_ * tile_px_; }
  [[nodiscard]] int height_px() const { return rows_ * tile_px_; }
  /// x and y of its least pixel.
  [[nodiscard]] std::array<int, 2> corner_px(std::size_t tile) const;
  [[nodiscard]] unsigned texture() const { return texture_; }

  /// Makes the atlas what is drawn into, by the least of old and new where `least`, else by the new.
  void bind(bool least) const;
  /// Leaves blending and the framebuffer as they are by default.
  static void unbind();
  /// Every pixel of the first `tiles` tiles, and perhaps of more, to `value`. The atlas must be bound.
  void clear(std::size_t tiles, float value) const;
  /// A rectangle of pixels, four floats each, row by row into `out`; nothing where the context is lost.
  void read(int x_px, int y_px, int width_px, int height_px, float* out) const;

 private:
  unsigned texture_ = 0;
  unsigned framebuffer_ = 0;
  int columns_ = 0, rows_ = 0, tile_px_ = 0;
};

}  // namespace roomradar
