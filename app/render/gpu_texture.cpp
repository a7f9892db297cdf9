// gpu_texture.cpp: uploads a texture and makes its mipmaps.
#include "app/render/gpu_texture.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <bit>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

GLint gl_wrap(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::kMirror:
      return GL_MIRRORED_REPEAT;
    case TextureWrap::kClamp:
      return GL_CLAMP_TO_EDGE;
    case TextureWrap::kRepeat:
      break;
  }
  return GL_REPEAT;
}

}  // namespace

GpuTexture::GpuTexture(GlContext& /*context*/, const Texture& texture) {
  const int width = texture.colour.width, height = texture.colour.height;
  if (!texture.opacity.empty()) least_opacity_ = static_cast<float>(texture.least_opacity) / 255.0F;
  forget_gl_errors();
  glCreateTextures(GL_TEXTURE_2D, 1, &name_);
  const int levels = std::bit_width(static_cast<unsigned>(std::max({width, height, 1})));
  glTextureStorage2D(name_, levels, GL_RGBA8, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (texture.opacity.empty()) {
    glTextureSubImage2D(name_, 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE,
                        texture.colour.pixels.data());
  } else {
    std::vector<std::uint8_t> rgba;
    rgba.reserve(4 * texture.colour.pixels.size());
    for (std::size_t i = 0; i < texture.colour.pixels.size(); ++i) {
      const Rgb& colour = texture.colour.pixels[i];
      rgba.insert(rgba.end(), {colour.r, colour.g, colour.b, texture.opacity.pixels[i]});
    }
    glTextureSubImage2D(name_, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glGenerateTextureMipmap(name_);
  glTextureParameteri(name_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(name_, GL_TEXTURE_MAG_FILTER, texture.is_pixelated ? GL_NEAREST : GL_LINEAR);
  glTextureParameteri(name_, GL_TEXTURE_WRAP_S, gl_wrap(texture.wrap_u));
  glTextureParameteri(name_, GL_TEXTURE_WRAP_T, gl_wrap(texture.wrap_v));
  try {
    require_drawn("texture");
  } catch (const Error&) {
    glDeleteTextures(1, &name_);
    throw;
  }
}

GpuTexture::~GpuTexture() { glDeleteTextures(1, &name_); }

}  // namespace roomradar
