// gl_texture.hpp: texture in the window's OpenGL context.
#pragma once
#include <cstdint>

#include "mapping/types/image.hpp"

namespace roomradar {

/// A texture in the window's OpenGL context, which must be current for all calls.
class GlTexture {
 public:
  /// @param smooth  true: magnified pixels are interpolated
  explicit GlTexture(bool smooth) : smooth_(smooth) {}
  ~GlTexture();
  GlTexture(const GlTexture&) = delete;
  GlTexture& operator=(const GlTexture&) = delete;

  void upload(const ColourImage& picture);
  /// @param picture  RGBA, red in the lowest byte
  void upload(const Image<std::uint32_t>& picture);
  /// Returns the texture in the form that Dear ImGui expects.
  [[nodiscard]] void* id() const;
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  bool smooth_;
  unsigned texture_ = 0;
  int width_ = 0, height_ = 0;

  void bind();
};

}  // namespace roomradar
