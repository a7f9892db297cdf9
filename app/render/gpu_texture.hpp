// gpu_texture.hpp: a base-colour texture in GPU memory.
#pragma once
#include "app/models/model.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// A texture with its mipmaps. Texture coordinate (0, 0) is the image's top left corner, (1, 1) its bottom
/// right corner.
class GpuTexture {
 public:
  /// Throws Error if GPU memory is exhausted. Textures of up to 16,384 x 16,384 px are supported by every
  /// OpenGL 4.5 renderer.
  GpuTexture(GlContext& context, const Texture& texture);
  ~GpuTexture();
  GpuTexture(const GpuTexture&) = delete;
  GpuTexture& operator=(const GpuTexture&) = delete;

  /// Returns the texture's GL name.
  [[nodiscard]] unsigned name() const { return name_; }
  /// Returns the alpha cutoff, 0..1, below which a pixel is not drawn; 0 for an opaque texture.
  [[nodiscard]] float least_opacity() const { return least_opacity_; }

 private:
  unsigned name_ = 0;
  float least_opacity_ = 0.0F;
};

}  // namespace roomradar
