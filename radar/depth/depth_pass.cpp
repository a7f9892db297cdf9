// depth_pass.cpp: draws depth only; with OpenGL, reads it back and converts it to metres.
#include "radar/depth/depth_pass.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "mapping/types/system/config_check.hpp"
#include "mapping/types/validity.hpp"
#include "radar/gl/gl_program.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {
namespace {

constexpr const char* kFragmentShader = R"(#version 450 core
void main() {}
)";

}  // namespace

void require_valid(const DepthPassConfig& config) {
  const ConfigCheck require{"depth_pass"};
  require(config.near_m > 0.0 && std::isfinite(config.near_m), "near_m", config.near_m, "> 0");
}

DepthPass::DepthPass(GlContext& context, const DepthPassConfig& config) : config_(config) {
  require_valid(config);
  const bool by_processor = config.renderer == DepthRenderer::kProcessor ||
                            (config.renderer == DepthRenderer::kAuto && context.is_software());
  if (by_processor) {
    raster_ = std::make_unique<DepthRaster>();
    return;
  }
  program_ = make_program("depth pass", kPositionShader, kFragmentShader);
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
  const int wide_px = std::max(width_px, texture_width_px_);
  const int high_px = std::max(height_px, texture_height_px_);
  texture_width_px_ = texture_height_px_ = 0;  // until the texture exists
  glDeleteTextures(1, &depth_texture_);
  glCreateTextures(GL_TEXTURE_2D, 1, &depth_texture_);
  glTextureStorage2D(depth_texture_, 1, GL_DEPTH_COMPONENT32F, wide_px, high_px);
  glNamedFramebufferTexture(framebuffer_, GL_DEPTH_ATTACHMENT, depth_texture_, 0);
  require_drawn("depth of the room");
  texture_width_px_ = wide_px;
  texture_height_px_ = high_px;
}

std::size_t DepthPass::render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                              const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m) {
  return render(scene, camera, T_world_camera, {0, 0, camera.width_px, camera.height_px}, depth_m);
}

std::size_t DepthPass::render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                              const Eigen::Isometry3d& T_world_camera, const PixelRect& rect,
                              DepthImage& depth_m) {
  if (!is_valid(camera)) {
    depth_m.resize(0, 0);
    return 0;
  }
  if (depth_m.width != camera.width_px || depth_m.height != camera.height_px) {
    depth_m.resize(camera.width_px, camera.height_px);
  }
  const PixelRect inside = clamped(rect, camera.width_px, camera.height_px);
  if (inside.width == 0 || inside.height == 0) return 0;
  if (raster_)
    return raster_->render(scene, camera, T_world_camera, inside,
                           {.near_m = config_.near_m, .cull_back_faces = config_.cull_back_faces}, depth_m);
  return render_with_gl(scene, camera, T_world_camera, inside, depth_m);
}

std::size_t DepthPass::render_with_gl(std::span<const MeshInstance> scene, const Intrinsics& camera,
                                      const Eigen::Isometry3d& T_world_camera, const PixelRect& inside,
                                      DepthImage& depth_m) {
  forget_gl_errors();
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
    if (instance.mesh != nullptr) drawn += draw_positions(instance, clip_from_world);
  }

  glPixelStorei(GL_PACK_ROW_LENGTH, depth_m.width);
  glReadPixels(0, 0, inside.width, inside.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               depth_m.row(inside.y) + inside.x);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  require_drawn("depth of the room");
  const float near_m = static_cast<float>(config_.near_m);
  for (int y = inside.y; y < inside.y + inside.height; ++y) {
    float* row = depth_m.row(y) + inside.x;
    for (int x = 0; x < inside.width; ++x) row[x] = depth_from_buffer(row[x], near_m);
  }
  return drawn;
}

PixelRect pixels_of(const MeshInstance& instance, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_world_camera, double near_m) {
  if (instance.mesh == nullptr) return {};
  return pixels_of(instance.mesh->bounds(), camera, T_world_camera.inverse() * instance.T_world_mesh, near_m);
}

}  // namespace roomradar
