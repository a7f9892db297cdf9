// depth_pass.cpp: draw depth only, read it back, turn it into metres.
#include "radar/depth_pass.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "mapping/types/error.hpp"
#include "radar/gl_program.hpp"

namespace roomradar {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 p_local;
layout(location = 0) uniform mat4 clip_from_local;
void main() { gl_Position = clip_from_local * vec4(p_local, 1.0); }
)";
constexpr const char* kFragmentShader = R"(#version 450 core
void main() {}
)";

bool is_usable(const Intrinsics& camera) {
  return camera.width_px > 0 && camera.height_px > 0 && camera.width_px <= 16384 &&
         camera.height_px <= 16384 && std::isfinite(camera.fx_px) && camera.fx_px > 0 &&
         std::isfinite(camera.fy_px) && camera.fy_px > 0 && std::isfinite(camera.cx_px) &&
         std::isfinite(camera.cy_px);
}

}  // namespace

void require_valid(const DepthPassConfig& config) {
  if (!(config.near_m > 0.0) || !std::isfinite(config.near_m)) {
    throw Error("depth_pass.near_m = " + std::to_string(config.near_m) + ": must be > 0");
  }
}

DepthPass::DepthPass(GlContext& /*context*/, const DepthPassConfig& config) : config_(config) {
  require_valid(config);
  program_ = make_program("depth pass", kVertexShader, kFragmentShader);
  glCreateFramebuffers(1, &framebuffer_);
  glNamedFramebufferDrawBuffer(framebuffer_, GL_NONE);
  glNamedFramebufferReadBuffer(framebuffer_, GL_NONE);
}

DepthPass::~DepthPass() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &depth_texture_);
  glDeleteProgram(program_);
}

void DepthPass::fit_framebuffer(int width_px, int height_px) {
  if (width_px <= texture_width_px_ && height_px <= texture_height_px_) return;
  texture_width_px_ = std::max(width_px, texture_width_px_);
  texture_height_px_ = std::max(height_px, texture_height_px_);
  glDeleteTextures(1, &depth_texture_);
  glCreateTextures(GL_TEXTURE_2D, 1, &depth_texture_);
  glTextureStorage2D(depth_texture_, 1, GL_DEPTH_COMPONENT32F, texture_width_px_, texture_height_px_);
  glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, depth_texture_, 0);
}

std::size_t DepthPass::render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                              const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m) {
  return render(scene, camera, T_world_camera, {0, 0, camera.width_px, camera.height_px}, depth_m);
}

std::size_t DepthPass::render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                              const Eigen::Isometry3d& T_world_camera, const PixelRect& rect,
                              DepthImage& depth_m) {
  if (!is_usable(camera)) {
    depth_m.resize(0, 0);
    return 0;
  }
  if (depth_m.width != camera.width_px || depth_m.height != camera.height_px) {
    depth_m.resize(camera.width_px, camera.height_px);
  }
  const PixelRect inside = clamped(rect, camera.width_px, camera.height_px);
  if (inside.width == 0 || inside.height == 0) return 0;

  fit_framebuffer(inside.width, inside.height);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, inside.width, inside.height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
  glFrontFace(GL_CW);  // image rows run down, framebuffer rows run up
  glCullFace(GL_BACK);
  config_.cull_back_faces ? glEnable(GL_CULL_FACE) : glDisable(GL_CULL_FACE);
  const GLfloat infinitely_far = 0.0F;
  glClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &infinitely_far);

  glUseProgram(program_);
  std::size_t drawn = 0;
  const Eigen::Matrix4d clip_from_world =
      clip_from_camera(camera, config_.near_m, inside) * T_world_camera.inverse().matrix();
  for (const MeshInstance& instance : scene) {
    if (instance.mesh == nullptr) continue;
    const Eigen::Matrix4d clip = clip_from_local(instance, clip_from_world);
    const Eigen::Matrix4f clip_float = clip.cast<float>();
    glUniformMatrix4fv(0, 1, GL_FALSE, clip_float.data());
    drawn += instance.mesh->draw(clip);
  }

  glPixelStorei(GL_PACK_ROW_LENGTH, depth_m.width);
  glReadPixels(0, 0, inside.width, inside.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               depth_m.row(inside.y) + inside.x);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  const float near_m = static_cast<float>(config_.near_m);
  for (int y = inside.y; y < inside.y + inside.height; ++y) {
    float* row = depth_m.row(y) + inside.x;
    for (int x = 0; x < inside.width; ++x) row[x] = depth_from_buffer(row[x], near_m);
  }
  return drawn;
}

PixelRect pixels_of(const MeshInstance& instance, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_world_camera, double near_m) {
  const PixelRect whole{0, 0, camera.width_px, camera.height_px};
  if (instance.mesh == nullptr || instance.mesh->bounds().isEmpty()) return {};
  const Eigen::AlignedBox3d bounds = instance.mesh->bounds();
  const Eigen::Isometry3d T_camera_mesh = T_world_camera.inverse() * instance.T_world_mesh;
  Eigen::AlignedBox2d seen;
  int behind = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p_camera =
        T_camera_mesh * bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    if (!(p_camera.z() > near_m)) {
      ++behind;
    } else {
      seen.extend(project(camera, p_camera));
    }
  }
  if (behind == 8) return {};
  if (behind > 0) return whole;
  // Pixels whose centres may be covered; one to spare for the renderer's snapping of vertices.
  const auto whole_px = [](double v_px, double limit_px) {
    return static_cast<int>(std::clamp(v_px, -1.0, limit_px + 1.0));
  };
  const int x0 = whole_px(std::floor(seen.min().x()), camera.width_px);
  const int y0 = whole_px(std::floor(seen.min().y()), camera.height_px);
  const int x1 = whole_px(std::ceil(seen.max().x()), camera.width_px);
  const int y1 = whole_px(std::ceil(seen.max().y()), camera.height_px);
  return clamped({x0, y0, x1 - x0 + 1, y1 - y0 + 1}, camera.width_px, camera.height_px);
}

}  // namespace roomradar
