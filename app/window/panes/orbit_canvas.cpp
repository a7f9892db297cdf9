// orbit_canvas.cpp: shaders, framebuffer and the mouse of a 3D view.
#include "app/window/panes/orbit_canvas.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "app/window/panes/theme.hpp"
#include "radar/gl/gl_program.hpp"

namespace roomradar {

DrawnMesh::DrawnMesh() {
  glGenVertexArrays(1, &vertex_array_);
  glGenBuffers(4, buffers_.data());
}

DrawnMesh::~DrawnMesh() {
  glDeleteBuffers(4, buffers_.data());
  glDeleteTextures(1, &texture_);
  glDeleteVertexArrays(1, &vertex_array_);
}

void DrawnMesh::upload(const Mesh& mesh, bool changes_often) {
  const auto fill = [&](GLenum target, unsigned buffer, const auto& values) {
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                 changes_often ? GL_STREAM_DRAW : GL_STATIC_DRAW);
  };
  origin_ = mesh.origin;
  has_colours_ = mesh.colours.size() == mesh.vertices.size() && !mesh.colours.empty();
  index_count_ = static_cast<int>(mesh.triangles.size() * 3);
  glBindVertexArray(vertex_array_);
  fill(GL_ARRAY_BUFFER, buffers_[0], mesh.vertices);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  if (has_colours_) {
    fill(GL_ARRAY_BUFFER, buffers_[1], mesh.colours);
    glVertexAttribPointer(1, 3, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
    glEnableVertexAttribArray(1);
  } else {
    glDisableVertexAttribArray(1);
  }
  fill(GL_ELEMENT_ARRAY_BUFFER, buffers_[2], mesh.triangles);
  glBindVertexArray(0);
}

void DrawnMesh::upload_texture(const std::vector<Eigen::Vector2f>& points, const ColourImage& texture) {
  glDeleteTextures(1, &texture_);
  texture_ = 0;
  glBindVertexArray(vertex_array_);
  glDisableVertexAttribArray(2);
  if (!points.empty() && !texture.empty()) {
    constexpr int kLevels = 4;  // coarser ones would mix charts
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[3]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(points[0])), points.data(),
                 GL_STATIC_DRAW);
    glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(2);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, texture.width, texture.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 texture.pixels.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kLevels - 1);
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  glBindVertexArray(0);
}

namespace {

constexpr double kNear_m = 0.05, kFar_m = 100.0;
constexpr double kFieldOfView_rad = 0.85;

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_local;
layout(location = 1) in vec3 colour_srgb;
layout(location = 2) in vec2 texture_point;
uniform mat4 clip_from_local;
uniform mat4 eye_from_local;
uniform vec4 plain;  // w: its weight against the vertices' colours
out vec3 p_eye;
out vec3 albedo;
out vec2 uv;
void main() {
  gl_Position = clip_from_local * vec4(p_local, 1.0);
  p_eye = (eye_from_local * vec4(p_local, 1.0)).xyz;
  albedo = mix(colour_srgb, plain.rgb, plain.a);
  uv = texture_point;
}
)";

// Flat shading, lit from the eye and from above, to show the mesh's shape.
constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 p_eye;
in vec3 albedo;
in vec2 uv;
uniform vec3 up_eye;
uniform sampler2D atlas;
uniform bool is_textured;
out vec4 colour;
void main() {
  vec3 n = normalize(cross(dFdx(p_eye), dFdy(p_eye)));
  float facing = abs(dot(n, normalize(-p_eye)));
  float above = 0.5 + 0.5 * dot(n, up_eye);
  float light = 0.35 + 0.40 * facing + 0.35 * above;
  colour = vec4(is_textured ? texture(atlas, uv).rgb * mix(1.0, light, 0.3) : albedo * light, 1.0);
}
)";

Eigen::Matrix4d perspective(double aspect) {
  const double cotangent = 1.0 / std::tan(0.5 * kFieldOfView_rad);
  Eigen::Matrix4d clip_from_eye = Eigen::Matrix4d::Zero();
  clip_from_eye(0, 0) = cotangent / aspect;
  clip_from_eye(1, 1) = cotangent;
  clip_from_eye(2, 2) = -(kFar_m + kNear_m) / (kFar_m - kNear_m);
  clip_from_eye(2, 3) = -2.0 * kFar_m * kNear_m / (kFar_m - kNear_m);
  clip_from_eye(3, 2) = -1.0;
  return clip_from_eye;
}

}  // namespace

Eigen::AlignedBox3d bounds_of(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  if (box.isEmpty()) return {};
  return {mesh.origin + box.min().cast<double>(), mesh.origin + box.max().cast<double>()};
}

Eigen::Isometry3d eye_of(const Orbit& orbit) {
  const double level = std::cos(orbit.elevation_rad);
  const Eigen::Vector3d back(level * std::cos(orbit.azimuth_rad), level * std::sin(orbit.azimuth_rad),
                             std::sin(orbit.elevation_rad));
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(back).normalized();
  Eigen::Isometry3d T_world_eye = Eigen::Isometry3d::Identity();
  T_world_eye.linear().col(0) = right;
  T_world_eye.linear().col(1) = back.cross(right);
  T_world_eye.linear().col(2) = back;
  T_world_eye.translation() = orbit.target_world + orbit.distance_m * back;
  return T_world_eye;
}

OrbitCanvas::OrbitCanvas() : program_(make_program("models", kVertexShader, kFragmentShader)) {}

OrbitCanvas::~OrbitCanvas() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  glDeleteProgram(program_);
}

bool OrbitCanvas::steer(const Area& area) {
  const ImGuiIO& io = ImGui::GetIO();
  const double dx = io.MouseDelta.x, dy = io.MouseDelta.y;
  const bool turns = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && !io.KeyShift;
  const bool shifts = ImGui::IsItemActive() && !turns;
  bool is_changed = false;
  if (turns && (dx != 0.0 || dy != 0.0)) {
    orbit.azimuth_rad -= 0.008 * dx;
    orbit.elevation_rad = std::clamp(orbit.elevation_rad + 0.008 * dy, -1.55, 1.55);
    is_changed = true;
  }
  if (shifts && (dx != 0.0 || dy != 0.0)) {
    const double m_per_px =
        2.0 * orbit.distance_m * std::tan(0.5 * kFieldOfView_rad) / static_cast<double>(area.height);
    const Eigen::Matrix3d R_world_eye = eye_of(orbit).linear();
    orbit.target_world += m_per_px * (-dx * R_world_eye.col(0) + dy * R_world_eye.col(1));
    is_changed = true;
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0F) {
    orbit.distance_m =
        std::clamp(orbit.distance_m * std::pow(0.88, static_cast<double>(io.MouseWheel)), 0.1, 40.0);
    is_changed = true;
  }
  if (is_changed) orbit_changed();
  return is_changed;
}

bool OrbitCanvas::must_render(int width_px, int height_px) {
  const bool is_resized = fit(width_px, height_px);
  if (!is_resized && !is_moved_ && !(is_stale_ && Clock::now() >= due_)) return false;
  is_stale_ = is_moved_ = false;
  return true;
}

/// Gives the texture this size. Returns true if it had another one.
bool OrbitCanvas::fit(int width_px, int height_px) {
  if (width_px == width_px_ && height_px == height_px_) return false;
  width_px_ = width_px;
  height_px_ = height_px;
  if (framebuffer_ == 0) {
    glGenFramebuffers(1, &framebuffer_);
    glGenTextures(1, &colour_);
    glGenRenderbuffers(1, &depth_);
  }
  glBindTexture(GL_TEXTURE_2D, colour_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_px, height_px);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return true;
}

void OrbitCanvas::begin() {
  begun_ = Clock::now();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_px_, height_px_);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(look::kGround);
  glClearColor(ground.x, ground.y, ground.z, ground.w);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(program_);
  T_eye_world_ = eye_of(orbit).inverse();
  clip_from_eye_ = perspective(static_cast<double>(width_px_) / height_px_);
  const Eigen::Vector3f up = T_eye_world_.linear().col(2).cast<float>();
  glUniform3fv(glGetUniformLocation(program_, "up_eye"), 1, up.data());
}

void OrbitCanvas::draw(const DrawnMesh& mesh, const Eigen::Isometry3d& T_world_mesh, const Tint& tint,
                       bool is_transparent_behind) {
  if (mesh.index_count_ == 0) return;
  (is_transparent_behind ? glEnable : glDisable)(GL_CULL_FACE);
  const Eigen::Matrix4d eye = (T_eye_world_ * T_world_mesh * Eigen::Translation3d(mesh.origin_)).matrix();
  const Eigen::Matrix4f eye_float = eye.cast<float>();
  const Eigen::Matrix4f clip_float = (clip_from_eye_ * eye).cast<float>();
  glUniformMatrix4fv(glGetUniformLocation(program_, "clip_from_local"), 1, GL_FALSE, clip_float.data());
  glUniformMatrix4fv(glGetUniformLocation(program_, "eye_from_local"), 1, GL_FALSE, eye_float.data());
  glUniform4f(glGetUniformLocation(program_, "plain"), tint.rgb[0], tint.rgb[1], tint.rgb[2],
              mesh.has_colours_ ? tint.fraction : 1.0F);
  glUniform1i(glGetUniformLocation(program_, "is_textured"), mesh.texture_ != 0 ? 1 : 0);
  glBindTexture(GL_TEXTURE_2D, mesh.texture_);
  glBindVertexArray(mesh.vertex_array_);
  glDrawElements(GL_TRIANGLES, mesh.index_count_, GL_UNSIGNED_INT, nullptr);
}

void OrbitCanvas::end() {
  glBindVertexArray(0);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  constexpr auto kLongestWait = std::chrono::milliseconds(200);
  glFinish();
  const Clock::time_point now = Clock::now();
  due_ = now + std::min<Clock::duration>(7 * (now - begun_), kLongestWait);
}

// Copied, not drawn as an image: llvmpipe takes 10 ns per pixel of an image, which it filters and blends.
void OrbitCanvas::show(const Area& area) {
  shown_at_ = area;
  ImGui::GetWindowDrawList()->AddCallback(
      [](const ImDrawList*, const ImDrawCmd* command) {
        static_cast<const OrbitCanvas*>(command->UserCallbackData)->copy_to_window();
      },
      this);
}

void OrbitCanvas::copy_to_window() const {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 scale = io.DisplayFramebufferScale;
  const auto px = [](float at) { return static_cast<GLint>(std::lround(at)); };
  const GLint left = px(shown_at_.x * scale.x);
  const GLint low = px((io.DisplaySize.y - shown_at_.y - shown_at_.height) * scale.y);
  const GLint right = left + px(static_cast<float>(width_px_) * scale.x);
  const GLint high = low + px(static_cast<float>(height_px_) * scale.y);
  const bool is_scaled = right - left != width_px_ || high - low != height_px_;
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBlitFramebuffer(0, 0, width_px_, height_px_, left, low, right, high, GL_COLOR_BUFFER_BIT,
                    is_scaled ? GL_LINEAR : GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glEnable(GL_SCISSOR_TEST);  // as Dear ImGui has it
}

ToWindow OrbitCanvas::to_window(const Area& area) const {
  const Eigen::Isometry3d T_eye_world = eye_of(orbit).inverse();
  const Eigen::Matrix4d clip_from_eye = clip_from_eye_;
  return [=](const Eigen::Vector3d& p_world) -> std::optional<ImVec2> {
    const Eigen::Vector3d p_eye = T_eye_world * p_world;
    if (p_eye.z() > -kNear_m) return std::nullopt;
    const Eigen::Vector4d clip = clip_from_eye * p_eye.homogeneous();
    return ImVec2(area.x + area.width * static_cast<float>(0.5 + 0.5 * clip.x() / clip.w()),
                  area.y + area.height * static_cast<float>(0.5 - 0.5 * clip.y() / clip.w()));
  };
}

}  // namespace roomradar
