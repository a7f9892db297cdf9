// gl_texture.cpp: uploads pictures to the window's renderer.
#include "app/window/panes/gl_texture.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <cstdint>

namespace roomradar {

GlTexture::~GlTexture() { glDeleteTextures(1, &texture_); }

void GlTexture::bind() {
  const bool is_new = texture_ == 0;
  if (is_new) glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  if (!is_new) return;
  const GLint filter = smooth_ ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void GlTexture::upload(const ColourImage& picture) {
  bind();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (picture.width != width_ || picture.height != height_) {
    width_ = picture.width;
    height_ = picture.height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 picture.pixels.data());
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, picture.pixels.data());
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void GlTexture::upload(const Image<std::uint32_t>& picture) {
  bind();
  width_ = picture.width;
  height_ = picture.height;
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               picture.pixels.data());
}

void* GlTexture::id() const { return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture_)); }

}  // namespace roomradar
