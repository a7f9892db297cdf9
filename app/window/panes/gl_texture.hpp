// gl_texture.hpp: a picture in the window's own OpenGL context.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// The window's context must be current wherever this is used.
class GlTexture {
 public:
  /// @param smooth  between pixels, when it is shown larger than it is
  explicit GlTexture(bool smooth) : smooth_(smooth) {}
  ~GlTexture();
  GlTexture(const GlTexture&) = delete;
  GlTexture& operator=(const GlTexture&) = delete;

  void upload(const ColourImage& picture);
  /// As Dear ImGui wants it.
  [[nodiscard]] void* id() const;
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  bool smooth_;
  unsigned texture_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace roomradar
