// tile_atlas.hpp: a float texture of square tiles, drawn into with minimum blending.
#pragma once
#include <array>
#include <cstddef>

#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Owns a texture of four 32 bit floats per pixel and its framebuffer. Not thread safe.
class TileAtlas {
 public:
  explicit TileAtlas(GlContext& context);
  ~TileAtlas();
  TileAtlas(const TileAtlas&) = delete;
  TileAtlas& operator=(const TileAtlas&) = delete;

  /// Makes columns x rows tiles of tile_px each; the contents are lost. Returns false if the renderer has no
  /// memory; then there are no tiles.
  [[nodiscard]] bool resize(int columns, int rows, int tile_px);
  [[nodiscard]] std::size_t tile_count() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }
  [[nodiscard]] int width_px() const { return columns_ * tile_px_; }
  [[nodiscard]] int height_px() const { return rows_ * tile_px_; }
  /// Least x and y of the tile's pixels.
  [[nodiscard]] std::array<int, 2> corner_px(std::size_t tile) const;
  [[nodiscard]] unsigned texture() const { return texture_; }

  /// Binds the atlas as the draw target, with minimum blending if `least`, else overwriting.
  void bind(bool least) const;
  /// Restores default blending and framebuffer.
  static void unbind();
  /// Sets every pixel of the first `tiles` tiles, and perhaps of more, to `value`. The atlas must be bound.
  void clear(std::size_t tiles, float value) const;
  /// Reads a rectangle of pixels, four floats each, row by row into `out`; writes nothing if the context is
  /// lost.
  void read(int x_px, int y_px, int width_px, int height_px, float* out) const;

 private:
  unsigned texture_ = 0;
  unsigned framebuffer_ = 0;
  int columns_ = 0, rows_ = 0, tile_px_ = 0;
};

}  // namespace roomradar
