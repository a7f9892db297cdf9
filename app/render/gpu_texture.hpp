// gpu_texture.hpp: a base-colour texture in the renderer's memory.
#pragma once
#include "app/models/model.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

/// A texture with its mipmaps. Texture points run from the picture's top left, right and down.
class GpuTexture {
 public:
  /// Throws Error if the renderer has no memory. Every OpenGL 4.5 renderer supports 16,384 px a side.
  GpuTexture(GlContext& context, const Texture& texture);
  ~GpuTexture();
  GpuTexture(const GpuTexture&) = delete;
  GpuTexture& operator=(const GpuTexture&) = delete;

  /// Returns the GL name.
  [[nodiscard]] unsigned name() const { return name_; }
  /// Returns the opacity, 0..1, below which a pixel is not drawn; 0 for an opaque texture.
  [[nodiscard]] float least_opacity() const { return least_opacity_; }

 private:
  unsigned name_ = 0;
  float least_opacity_ = 0.0F;
};

}  // namespace roomradar
