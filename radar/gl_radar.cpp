// gl_radar.cpp: M, then R through M, one readback, the least L.
#include "radar/gl_radar.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "mapping/types/error.hpp"
#include "radar/draw_positions.hpp"
#include "radar/gl_program.hpp"
#include "radar/nearest_triangle.hpp"

namespace roomradar {
namespace {

constexpr double kMaxDistance_m = 1e4;  // beyond it a step of 32 bit depth is 0.6 mm

constexpr const char* kMaskShader = R"(#version 450 core
void main() {}
)";

// The object's surface behind its front that is entered along the motion: the rear of the front slab of its
// solid. Front-facing means opposing the motion. M runs from the far plane, so behind the front means larger.
constexpr const char* kEntryShader = R"(#version 450 core
layout(binding = 0) uniform sampler2D mask01;
layout(location = 1) uniform float touching01;
void main() {
  float m = texelFetch(mask01, ivec2(gl_FragCoord.xy), 0).r;
  if (!gl_FrontFacing || gl_FragCoord.z <= m + touching01) discard;
}
)";

// The scene through the object's outline, passing over what is behind the object's front (see GlRadar).
constexpr const char* kRangeShader = R"(#version 450 core
layout(binding = 0) uniform sampler2D mask01;
layout(binding = 1) uniform sampler2D entry01;
layout(location = 1) uniform float touching01;
layout(location = 2) uniform float tolerance01;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float m = texelFetch(mask01, pixel, 0).r;
  if (m == 1.0) discard;
  float slab01 = texelFetch(entry01, pixel, 0).r - m;
  float behind01 = gl_FrontFacing ? max(touching01, min(tolerance01, slab01)) : touching01;
  if (gl_FragCoord.z + m - 1.0 < -behind01) discard;
}
)";

}  // namespace

void require_valid(const GlRadarConfig& config) {
  if (config.resolution_px < 1 || config.resolution_px > 4096) {
    throw Error("radar.resolution_px = " + std::to_string(config.resolution_px) + ": must be in 1..4096");
  }
  if (!(config.overlap_tolerance_m >= 0.0) || !std::isfinite(config.overlap_tolerance_m)) {
    throw Error("radar.overlap_tolerance_m = " + std::to_string(config.overlap_tolerance_m) +
                ": must be >= 0");
  }
}

GlRadar::GlRadar(GlContext& context, const GlRadarConfig& config) : config_(config) {
  require_valid(config);
  GLint max_size_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size_px);
  if (config.resolution_px > max_size_px) {
    throw Error("radar.resolution_px = " + std::to_string(config.resolution_px) + ": " + context.renderer() +
                " draws at most " + std::to_string(max_size_px));
  }
  mask_program_ = make_program("radar mask", kPositionShader, kMaskShader);
  range_program_ = make_program("radar range", kPositionShader, kRangeShader);
  entry_program_ = make_program("radar entry", kPositionShader, kEntryShader);
  glCreateTextures(GL_TEXTURE_2D, kLayerCount, textures_.data());
  glCreateFramebuffers(kLayerCount, framebuffers_.data());
  for (std::size_t layer = 0; layer < kLayerCount; ++layer) {
    glTextureStorage2D(textures_[layer], 1, GL_DEPTH_COMPONENT32F, config.resolution_px,
                       config.resolution_px);
    glTextureParameteri(textures_[layer], GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(textures_[layer], GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glNamedFramebufferTexture(framebuffers_[layer], GL_DEPTH_ATTACHMENT, textures_[layer], 0);
    glNamedFramebufferDrawBuffer(framebuffers_[layer], GL_NONE);
    glNamedFramebufferReadBuffer(framebuffers_[layer], GL_NONE);
  }
  const auto pixels = static_cast<GLsizeiptr>(config.resolution_px) * config.resolution_px;
  glCreateBuffers(1, &readback_buffer_);
  glNamedBufferStorage(readback_buffer_, 2 * pixels * static_cast<GLsizeiptr>(sizeof(float)), nullptr,
                       GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
}

GlRadar::~GlRadar() {
  glDeleteBuffers(1, &readback_buffer_);
  glDeleteFramebuffers(kLayerCount, framebuffers_.data());
  glDeleteTextures(kLayerCount, textures_.data());
  for (const unsigned program : {mask_program_, range_program_, entry_program_}) glDeleteProgram(program);
}

Contact GlRadar::query(const MeshInstance& object, const Eigen::Vector3d& direction_world, double distance_m,
                       std::span<const SceneMesh> scene) {
  volume_ = {};
  for (Image<float>* image : {&range_m_, &mask_m_, &lookat_m_}) image->resize(0, 0);
  const double direction_norm = direction_world.stableNorm();
  const auto has_bad_pose = [](const SceneMesh& s) {
    return s.instance.mesh != nullptr && !s.instance.T_world_mesh.matrix().allFinite();
  };
  if (!direction_world.allFinite() || !(direction_norm > 0.0) || !(distance_m > 0.0) ||
      !(distance_m <= kMaxDistance_m) || object.mesh == nullptr || object.mesh->triangle_count() == 0 ||
      !object.T_world_mesh.matrix().allFinite() || std::any_of(scene.begin(), scene.end(), has_bad_pose)) {
    return {};
  }

  volume_ = fit_volume(object, direction_world / direction_norm, distance_m, config_.resolution_px);
  const auto far_m = static_cast<float>(volume_.depth_m);
  range_m_.resize(volume_.width_px, volume_.height_px, far_m);
  mask_m_.resize(volume_.width_px, volume_.height_px, far_m);
  lookat_m_.resize(volume_.width_px, volume_.height_px, std::numeric_limits<float>::quiet_NaN());
  Contact nothing;
  nothing.status = ContactStatus::kNoTarget;
  nothing.pixel_m = volume_.pixel_m;
  const Eigen::Matrix4d clip = clip_from_world(volume_);
  const auto reaches_volume = [&](const SceneMesh& s) {
    return s.instance.mesh != nullptr && s.instance.mesh->reaches(clip_from_local(s.instance, clip));
  };
  if (std::none_of(scene.begin(), scene.end(), reaches_volume)) return nothing;

  draw_mask(object);
  begin_layer(kEntry, entry_program_);  // cleared: as if the object were solid to its rear
  draw_range(scene);
  std::optional<double> least_m = read_and_compare();
  // An overlap, or only something in a hollow of the object? Look again, closer.
  if (least_m && *least_m < -touching_m()) {
    draw_entry(object);
    draw_range(scene);
    least_m = read_and_compare();
  }
  if (!least_m) {
    nothing.status = ContactStatus::kNoAnswer;
    return nothing;
  }
  if (!(*least_m <= distance_m + touching_m())) return nothing;
  return contact_at_least_gap(*least_m, scene);
}

double GlRadar::touching_m() const { return 1e-5 + 1e-6 * volume_.depth_m; }

void GlRadar::begin_layer(Layer layer, unsigned program) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[layer]);
  glViewport(0, 0, volume_.width_px, volume_.height_px);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, volume_.width_px, volume_.height_px);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glFrontFace(GL_CW);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  const GLfloat far01 = 1.0F;
  glClearBufferfv(GL_DEPTH, 0, &far01);
  glUseProgram(program);
}

void GlRadar::draw_mask(const MeshInstance& object) const {
  begin_layer(kMask, mask_program_);
  draw_positions(object, reflected_clip_from_world(volume_));
}

void GlRadar::draw_entry(const MeshInstance& object) const {
  begin_layer(kEntry, entry_program_);
  glBindTextureUnit(0, textures_[kMask]);
  glUniform1f(1, static_cast<float>(touching_m() / volume_.depth_m));
  draw_positions(object, reflected_clip_from_world(volume_));
}

void GlRadar::draw_range(std::span<const SceneMesh> scene) const {
  begin_layer(kRange, range_program_);
  glBindTextureUnit(0, textures_[kMask]);
  glBindTextureUnit(1, textures_[kEntry]);
  const double tolerance_m = std::min(config_.overlap_tolerance_m, volume_.length_m);
  glUniform1f(1, static_cast<float>(touching_m() / volume_.depth_m));
  glUniform1f(2, static_cast<float>(tolerance_m / volume_.depth_m));
  const Eigen::Matrix4d clip = clip_from_world(volume_);
  for (const SceneMesh& s : scene) {
    if (s.instance.mesh != nullptr) draw_positions(s.instance, clip);
  }
}

/// Reads M and R, fills the images, and returns the least L, infinite where L is defined nowhere; or nothing
/// if the renderer does not hand them out.
std::optional<double> GlRadar::read_and_compare() {
  const std::size_t count = mask_m_.pixels.size();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, readback_buffer_);
  for (const Layer layer : {kMask, kRange}) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_[layer]);
    glReadPixels(0, 0, volume_.width_px, volume_.height_px, GL_DEPTH_COMPONENT, GL_FLOAT,
                 reinterpret_cast<void*>(layer * count * sizeof(float)));
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  const auto size_bytes = static_cast<GLsizeiptr>(2 * count * sizeof(float));
  const auto* mask01 =
      static_cast<const float*>(glMapNamedBufferRange(readback_buffer_, 0, size_bytes, GL_MAP_READ_BIT));
  if (mask01 == nullptr) return std::nullopt;
  const float* range01 = mask01 + count;
  const auto depth_m = static_cast<float>(volume_.depth_m);
  constexpr float kUndefined = std::numeric_limits<float>::quiet_NaN();
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const float r = range01[i];
    const float m = mask01[i];
    const bool defined = m < 1.0F && r < 1.0F;
    // m - 1 loses nothing for m in 0.5..1, and r + (m - 1) is the difference of two near numbers: exact at
    // contact.
    const float gap_m = (r + (m - 1.0F)) * depth_m;
    range_m_.pixels[i] = r * depth_m;
    mask_m_.pixels[i] = m * depth_m;
    lookat_m_.pixels[i] = defined ? gap_m : kUndefined;
    least = defined && gap_m < least ? gap_m : least;
  }
  glUnmapNamedBuffer(readback_buffer_);
  return least;
}

Contact GlRadar::contact_at_least_gap(double least_m, std::span<const SceneMesh> scene) const {
  // The middle of all pixels that are as near as the nearest, then the one of them closest to it.
  const auto equally_near_m = static_cast<float>(least_m + touching_m());
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int y = 0; y < lookat_m_.height; ++y) {
    for (int x = 0; x < lookat_m_.width; ++x) {
      if (!(lookat_m_.at(x, y) <= equally_near_m)) continue;
      middle_px += Eigen::Vector2d(x, y);
      count += 1.0;
    }
  }
  middle_px /= count;
  int best_x = 0, best_y = 0;
  double best_px2 = std::numeric_limits<double>::infinity();
  for (int y = 0; y < lookat_m_.height; ++y) {
    for (int x = 0; x < lookat_m_.width; ++x) {
      const double off_px2 = (Eigen::Vector2d(x, y) - middle_px).squaredNorm();
      if (!(lookat_m_.at(x, y) <= equally_near_m) || off_px2 >= best_px2) continue;
      best_px2 = off_px2;
      best_x = x;
      best_y = y;
    }
  }

  Contact contact;
  contact.status = least_m < -touching_m() ? ContactStatus::kOverlap : ContactStatus::kContact;
  contact.travel_m = contact.status == ContactStatus::kContact ? std::max(least_m, 0.0) : least_m;
  contact.pixel_m = volume_.pixel_m;
  contact.point_world = volume_.origin_world + (best_x + 0.5) * volume_.pixel_m * volume_.x_world +
                        (best_y + 0.5) * volume_.pixel_m * volume_.y_world +
                        range_m_.at(best_x, best_y) * volume_.u_world;

  // The renderer snaps vertices to 1/256 pixel, so the point may lie that far beside its triangle; look wider
  // if need be.
  contact.normal_world = -volume_.u_world;
  std::optional<NearestTriangle> nearest;
  for (double within_m = 0.05 * volume_.pixel_m + touching_m(); !nearest && within_m < volume_.depth_m;
       within_m *= 16.0) {
    for (const SceneMesh& s : scene) {
      if (s.instance.mesh == nullptr) continue;
      const auto found = nearest_triangle(s.instance, contact.point_world, volume_.u_world,
                                          nearest ? nearest->distance_m : within_m);
      if (!found || (nearest && found->distance_m >= nearest->distance_m)) continue;
      nearest = found;
      contact.touched = s.kind;
    }
  }
  if (nearest) {
    const bool faces_object = nearest->normal_world.dot(volume_.u_world) <= 0.0;
    contact.normal_world = faces_object ? nearest->normal_world : Eigen::Vector3d(-nearest->normal_world);
  }
  return contact;
}

}  // namespace roomradar
