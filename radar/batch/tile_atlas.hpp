// tile_atlas.hpp: a float texture divided into square tiles, one per query or mask, drawn with minimum
// blending.
#pragma once
#include <array>
#include <cstddef>

#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// Owns a texture with four 32 bit floats per pixel, and its framebuffer. Not thread safe.
class TileAtlas {
 public:
  explicit TileAtlas(GlContext& context);
  ~TileAtlas();
  TileAtlas(const TileAtlas&) = delete;
  TileAtlas& operator=(const TileAtlas&) = delete;

  /// Resizes to columns x rows tiles of tile_px x tile_px pixels. The earlier contents are lost. If the
  /// renderer has no memory, returns false and leaves the atlas without tiles.
  [[nodiscard]] bool resize(int columns, int rows, int tile_px);
  [[nodiscard]] std::size_t tile_count() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }
  [[nodiscard]] int width_px() const { return columns_ * tile_px_; }
  [[nodiscard]] int height_px() const { return rows_ * tile_px_; }
  /// Returns the x and y of the tile's first pixel.
  [[nodiscard]] std::array<int, 2> corner_px(std::size_t tile) const;
  [[nodiscard]] unsigned texture() const { return texture_; }

  /// Binds the texture as the draw target. Fragments are combined by minimum blending if `least` is true,
  /// else they overwrite.
  void bind(bool least) const;
  /// Restores default blending and the default framebuffer.
  static void unbind();
  /// Sets every pixel of the first `tiles` tiles to `value`, and possibly pixels of later tiles. The atlas
  /// must be bound.
  void clear(std::size_t tiles, float value) const;
  /// Reads a rectangle of pixels into `out`, row by row, four floats per pixel. Writes nothing if the context
  /// is lost.
  void read(int x_px, int y_px, int width_px, int height_px, float* out) const;

 private:
  unsigned texture_ = 0;
  unsigned framebuffer_ = 0;
  int columns_ = 0, rows_ = 0, tile_px_ = 0;
};

}  // namespace roomradar
