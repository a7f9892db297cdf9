// draw.cpp: renders virtual objects with OpenGL.
#include "app/render/draw.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "mapping/types/system/error.hpp"
#include "radar/depth/depth_pass.hpp"
#include "radar/gl/gl_program.hpp"

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

namespace {

constexpr double kNear_m = 0.05;
constexpr int kMaxSupersampled_px = 80'000;  // a quarter of a 640 x 480 picture

// The shaders are compiled with and without textures, so that objects without one do not pay for them.
constexpr const char* kPlain = "#version 450 core\n";
constexpr const char* kTextured = "#version 450 core\n#define TEXTURED\n";

constexpr const char* kVertexShader = R"(
layout(location = 0) in vec3 p_local;
layout(location = 1) in vec3 normal_local;
layout(location = 2) in vec3 colour_srgb;
#ifdef TEXTURED
layout(location = 3) in vec2 texture_point;
out vec2 p_texture;
#endif
layout(location = 0) uniform mat4 clip_from_local;
layout(location = 1) uniform mat4 eye_from_local;  // world axes, camera at the origin
layout(location = 2) uniform vec4 plain_srgb;      // used if w is 1, else the vertices' colours
out vec3 p_eye;
out vec3 normal_eye;
out vec3 albedo;
void main() {
  gl_Position = clip_from_local * vec4(p_local, 1.0);
  p_eye = (eye_from_local * vec4(p_local, 1.0)).xyz;
  normal_eye = mat3(eye_from_local) * normal_local;
  albedo = mix(colour_srgb, plain_srgb.rgb, plain_srgb.a);
  albedo *= albedo;  // gamma 2 approximates sRGB without a pow() per pixel
#ifdef TEXTURED
  p_texture = texture_point;
#endif
}
)";

// The estimated light of the room, or a default one: ambient light, stronger from above, and one broad lamp.
// Both with reflections on glaze. Highlight: normalised Blinn-Phong. Grazing reflection: Schlick's
// approximation of the Fresnel term.
constexpr const char* kFragmentShader = R"(
in vec3 p_eye;
in vec3 normal_eye;
in vec3 albedo;
#ifdef TEXTURED
in vec2 p_texture;
layout(binding = 0) uniform sampler2D base_srgb;
layout(location = 7) uniform float least_opacity;
#endif
layout(location = 3) uniform vec3 up;
layout(location = 4) uniform vec3 to_light;
layout(location = 5) uniform vec2 exposure_gloss;
layout(location = 6) uniform bool has_normals;
layout(location = 8) uniform bool has_room_light;
layout(location = 9) uniform vec3 room_light[9];  // coefficients of light_basis()
layout(location = 18) uniform vec3 room_lamp;     // irradiance facing the main light
layout(location = 19) uniform vec3 to_room_lamp;
out vec4 colour;
const vec3 sky = vec3(0.80, 0.83, 0.88);
const vec3 ground = vec3(0.26, 0.23, 0.20);
const vec3 lamp = vec3(0.85, 0.80, 0.72);
vec3 irradiance(vec3 n) {
  vec3 sum = room_light[0] + room_light[1] * n.x + room_light[2] * n.y + room_light[3] * n.z
           + room_light[4] * (n.x * n.y) + room_light[5] * (n.y * n.z) + room_light[6] * (n.z * n.x)
           + room_light[7] * (3.0 * n.z * n.z - 1.0) + room_light[8] * (n.x * n.x - n.y * n.y);
  return max(sum, vec3(0.0));
}
void main() {
  vec3 to_eye = normalize(-p_eye);
  vec3 facet = normalize(cross(dFdx(p_eye), dFdy(p_eye)));
  if (dot(facet, to_eye) < 0.0) facet = -facet;
  vec3 n = has_normals && dot(normal_eye, normal_eye) > 0.0 ? normalize(normal_eye) : facet;
  if (dot(n, facet) < 0.0) n = -n;  // back side of an open mesh
  vec3 to_lamp = has_room_light ? to_room_lamp : to_light;
  float lambert = max(dot(n, to_lamp), 0.0);
  vec3 halfway = normalize(to_lamp + to_eye);
  float highlight = max(dot(n, halfway), 0.0);  // to the power of 64
  highlight *= highlight; highlight *= highlight; highlight *= highlight;
  highlight *= highlight; highlight *= highlight; highlight *= highlight;
  highlight *= 2.5 * step(0.0, dot(n, to_lamp));
  float away = 1.0 - max(dot(n, to_eye), 0.0);
  float fresnel = 0.04 + 0.96 * away * away * away * away * away;
  vec3 mirror = reflect(-to_eye, n);
  vec3 base = albedo;
#ifdef TEXTURED
  vec4 texel = texture(base_srgb, p_texture);
  if (texel.a < least_opacity) discard;
  base *= texel.rgb * texel.rgb;  // gamma 2, as for colours
#endif
  if (has_room_light) {
    vec3 glaze = room_lamp * highlight + fresnel * irradiance(mirror);
    colour = vec4(sqrt(base * irradiance(n) + exposure_gloss.y * glaze), 1.0);
    return;
  }
  vec3 ambient = mix(ground, sky, 0.5 + 0.5 * dot(n, up));
  vec3 mirrored = mix(ground, sky, smoothstep(-0.3, 0.6, dot(mirror, up)));
  vec3 light = base * (ambient * 0.75 + lamp * lambert * 0.75)
             + exposure_gloss.y * (lamp * highlight + fresnel * mirrored);
  light *= exposure_gloss.x;
  colour = vec4(sqrt(light / (1.0 + 0.15 * light)), 1.0);
}
)";

unsigned program_with(const char* head, const char* name) {
  return make_program(
      name, {{GL_VERTEX_SHADER, {head, kVertexShader}}, {GL_FRAGMENT_SHADER, {head, kFragmentShader}}});
}

bool has_texture(const DrawnObject& object) {
  return std::any_of(object.parts.begin(), object.parts.end(),
                     [](const DrawnPart& part) { return part.texture != nullptr; });
}

}  // namespace

struct ObjectDrawer::State {
  unsigned plain = 0, textured = 0;  ///< programs; 0: not compiled, since no texture has been drawn so far
  unsigned framebuffer = 0;
  std::array<unsigned, 2> textures{};  // colour, depth
  int width_px = 0;
  int height_px = 0;
  int most_px = 0;  ///< max texture size along a side

  void fit(int wanted_width_px, int wanted_height_px) {
    if (wanted_width_px <= width_px && wanted_height_px <= height_px) return;
    const int wide_px = std::max(wanted_width_px, width_px);
    const int high_px = std::max(wanted_height_px, height_px);
    width_px = height_px = 0;  // until the textures are created
    glDeleteTextures(2, textures.data());
    glCreateTextures(GL_TEXTURE_2D, 2, textures.data());
    glTextureStorage2D(textures[0], 1, GL_RGBA8, wide_px, high_px);
    glTextureStorage2D(textures[1], 1, GL_DEPTH_COMPONENT32F, wide_px, high_px);
    glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, textures[0], 0);
    glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, textures[1], 0);
    require_drawn("virtual objects");
    width_px = wide_px;
    height_px = high_px;
  }

  /// Sets the values that are the same for all objects.
  static void set_lighting(unsigned program, const Lighting& lighting) {
    const Eigen::Vector3f up = lighting.up_world.normalized().cast<float>();
    const Eigen::Vector3f to_light = lighting.to_key_light_world.normalized().cast<float>();
    glProgramUniform3fv(program, 3, 1, up.data());
    glProgramUniform3fv(program, 4, 1, to_light.data());
    glProgramUniform2f(program, 5, lighting.exposure, lighting.gloss);
  }

  /// Sets an object's own light, if it has one.
  static void set_light(const SplitLight* light) {
    glUniform1i(8, light != nullptr ? 1 : 0);
    if (light == nullptr) return;
    const Eigen::Matrix<float, 3, 9> coefficients =
        light->whole.coefficients.transpose();  // a vec3 per column
    const Eigen::Vector3f to_lamp = light->main.to_light_world.cast<float>();
    glUniform3fv(9, 9, coefficients.data());
    glUniform3fv(18, 1, light->main.directed.data());
    glUniform3fv(19, 1, to_lamp.data());
  }

  /// Draws a mesh at a pose.
  void draw(const DrawnPart& part, const DrawnObject& object, const Eigen::Matrix4d& clip_from_world,
            const Eigen::Vector3d& camera_world) const {
    const GpuMesh& mesh = *part.mesh;
    const MeshInstance instance{&mesh, object.instance.T_world_mesh};
    const Eigen::Matrix4d clip = clip_from_local(instance, clip_from_world);
    const Eigen::Matrix4f clip_float = clip.cast<float>();
    // Relative to the camera, in double, to keep precision in a room far from the world's origin.
    Eigen::Isometry3d eye = instance.T_world_mesh * Eigen::Translation3d(mesh.origin());
    eye.translation() -= camera_world;
    const Eigen::Matrix4f eye_float = eye.matrix().cast<float>();
    const auto level = [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0F; };
    glUseProgram(part.texture != nullptr ? textured : plain);
    glUniformMatrix4fv(0, 1, GL_FALSE, clip_float.data());
    glUniformMatrix4fv(1, 1, GL_FALSE, eye_float.data());
    const Rgb colour = part.texture != nullptr ? Rgb{255, 255, 255} : object.colour;
    glUniform4f(2, level(colour.r), level(colour.g), level(colour.b), mesh.has_colours() ? 0.0F : 1.0F);
    glUniform1i(6, mesh.has_normals() ? 1 : 0);
    set_light(object.light);
    if (part.texture != nullptr) {
      glUniform1f(7, part.texture->least_opacity());
      glBindTextureUnit(0, part.texture->name());
    }
    object.is_closed ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
    mesh.draw(clip);
  }

  /// Binds and clears the framebuffer, and sets depth test and culling.
  void prepare(int width, int height) {
    forget_gl_errors();
    fit(width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glFrontFace(GL_CW);  // image rows run down, framebuffer rows run up
    glCullFace(GL_BACK);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const std::array<GLfloat, 4> black{};
    const GLfloat infinitely_far = 0.0F;
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, black.data());
    glClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &infinitely_far);
  }
};

ObjectDrawer::ObjectDrawer(GlContext& /*context*/) : state_(std::make_unique<State>()) {
  state_->plain = program_with(kPlain, "virtual objects");
  glCreateFramebuffers(1, &state_->framebuffer);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &state_->most_px);
}

ObjectDrawer::~ObjectDrawer() {
  glDeleteFramebuffers(1, &state_->framebuffer);
  glDeleteTextures(2, state_->textures.data());
  glDeleteProgram(state_->plain);
  glDeleteProgram(state_->textured);
}

void ObjectDrawer::begin(std::span<const DrawnObject> objects, const Intrinsics& camera,
                         const Eigen::Isometry3d& T_world_camera, const Lighting& lighting,
                         ObjectLayer& layer) {
  PixelRect rect;
  for (const DrawnObject& object : objects)
    rect = united(rect, pixels_of(object.instance, camera, T_world_camera, kNear_m));
  layer.rect = clamped(rect, camera.width_px, camera.height_px);
  const bool fits_twice = 2 * std::max(layer.rect.width, layer.rect.height) <= state_->most_px;
  layer.samples = fits_twice && layer.rect.width * layer.rect.height <= kMaxSupersampled_px ? 2 : 1;
  const int width = layer.rect.width * layer.samples;
  const int height = layer.rect.height * layer.samples;
  layer.colour.resize(width, height);
  layer.depth_m.resize(width, height);
  if (width == 0 || height == 0) return;

  state_->prepare(width, height);
  if (state_->textured == 0 && std::any_of(objects.begin(), objects.end(), has_texture))
    state_->textured = program_with(kTextured, "textured virtual objects");
  for (const unsigned program : {state_->plain, state_->textured})
    if (program != 0) State::set_lighting(program, lighting);
  const Intrinsics fine_camera = scaled(camera, layer.samples);
  const PixelRect fine_rect{layer.rect.x * layer.samples, layer.rect.y * layer.samples, width, height};
  const Eigen::Matrix4d clip_from_world =
      clip_from_camera(fine_camera, kNear_m, fine_rect) * T_world_camera.inverse().matrix();
  for (const DrawnObject& object : objects) {
    if (object.instance.mesh == nullptr) continue;
    const Eigen::Vector3d& camera_world = T_world_camera.translation();
    if (object.parts.empty())
      state_->draw({object.instance.mesh, nullptr}, object, clip_from_world, camera_world);
    for (const DrawnPart& part : object.parts) state_->draw(part, object, clip_from_world, camera_world);
  }
  require_drawn("virtual objects");  // before later calls clear GL errors
  glFlush();
}

void ObjectDrawer::finish(ObjectLayer& layer) {
  const int width = layer.colour.width, height = layer.colour.height;
  if (width == 0 || height == 0) return;
  glBindFramebuffer(GL_FRAMEBUFFER, state_->framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, layer.colour.pixels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, layer.depth_m.pixels.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  require_drawn("virtual objects");
  for (float& depth_m : layer.depth_m.pixels)
    depth_m = depth_from_buffer(depth_m, static_cast<float>(kNear_m));
}

}  // namespace roomradar
