// model_view.cpp: renders meshes seen by an orbiting eye.
#include "app/window/panes/model_view.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "app/window/panes/annotate.hpp"
#include "radar/gl/gl_program.hpp"

namespace roomradar {
namespace {

constexpr double kNear_m = 0.05, kFar_m = 100.0;
constexpr double kFieldOfView_rad = 0.85;
constexpr double kLookedAt_m = 1.0;  // in front of the camera, where users place objects

constexpr const char* kVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_local;
layout(location = 1) in vec3 colour_srgb;
uniform mat4 clip_from_local;
uniform mat4 eye_from_local;
uniform vec4 plain;  // w: its weight against the vertices' colours
out vec3 p_eye;
out vec3 albedo;
void main() {
  gl_Position = clip_from_local * vec4(p_local, 1.0);
  p_eye = (eye_from_local * vec4(p_local, 1.0)).xyz;
  albedo = mix(colour_srgb, plain.rgb, plain.a);
}
)";

// Flat shading, lit from the eye and from above, to show the mesh's shape.
constexpr const char* kFragmentShader = R"(#version 330 core
in vec3 p_eye;
in vec3 albedo;
uniform vec3 up_eye;
out vec4 colour;
void main() {
  vec3 n = normalize(cross(dFdx(p_eye), dFdy(p_eye)));
  float facing = abs(dot(n, normalize(-p_eye)));
  float above = 0.5 + 0.5 * dot(n, up_eye);
  colour = vec4(albedo * (0.35 + 0.40 * facing + 0.35 * above), 1.0);
}
)";

/// A mesh in the window's GL context.
struct DrawnMesh {
  unsigned vertex_array = 0;
  std::array<unsigned, 3> buffers{};  // positions, colours, indices
  GLsizei index_count = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  bool has_colours = false;

  DrawnMesh() {
    glGenVertexArrays(1, &vertex_array);
    glGenBuffers(3, buffers.data());
  }
  ~DrawnMesh() {
    glDeleteBuffers(3, buffers.data());
    glDeleteVertexArrays(1, &vertex_array);
  }
  DrawnMesh(const DrawnMesh&) = delete;
  DrawnMesh& operator=(const DrawnMesh&) = delete;

  void upload(const Mesh& mesh, GLenum usage) {
    const auto fill = [&](GLenum target, unsigned buffer, const auto& values) {
      glBindBuffer(target, buffer);
      glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(), usage);
    };
    origin = mesh.origin;
    has_colours = mesh.colours.size() == mesh.vertices.size() && !mesh.colours.empty();
    index_count = static_cast<GLsizei>(mesh.triangles.size() * 3);
    glBindVertexArray(vertex_array);
    fill(GL_ARRAY_BUFFER, buffers[0], mesh.vertices);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(0);
    if (has_colours) {
      fill(GL_ARRAY_BUFFER, buffers[1], mesh.colours);
      glVertexAttribPointer(1, 3, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
      glEnableVertexAttribArray(1);
    } else {
      glDisableVertexAttribArray(1);
    }
    fill(GL_ELEMENT_ARRAY_BUFFER, buffers[2], mesh.triangles);
    glBindVertexArray(0);
  }
};

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

Eigen::AlignedBox3d bounds_of(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  if (box.isEmpty()) return {};
  return {mesh.origin + box.min().cast<double>(), mesh.origin + box.max().cast<double>()};
}

/// Draws the meaning of the colours along the bottom, in as many rows as the width needs.
void draw_legend(ImDrawList& list, const Area& area, const look::Fonts& fonts) {
  struct Entry {
    ImU32 colour;
    const char* what;
    float x = 0.0F;
    int row = 0;
  };
  std::array<Entry, 4> legend = {{{IM_COL32(158, 168, 184, 255), "room"},
                                  {IM_COL32(237, 115, 102, 255), "dynamic"},
                                  {IM_COL32(140, 92, 158, 255), "inferred back"},
                                  {IM_COL32(64, 196, 172, 255), "chosen object"}}};
  const float margin = look::px(12.0F), beside_dot = look::px(9.0F), size = fonts.small->FontSize;
  float x = margin;
  int row = 0;
  for (Entry& entry : legend) {
    const float wide = beside_dot + fonts.small->CalcTextSizeA(size, 1e4F, 0.0F, entry.what).x;
    if (x > margin && x + wide > area.width - margin) {
      x = margin;
      ++row;
    }
    entry.x = area.x + x;
    entry.row = row;
    x += wide + look::px(16.0F);
  }
  for (const Entry& entry : legend) {
    const float y =
        area.y + area.height - look::px(22.0F) - look::px(16.0F) * static_cast<float>(row - entry.row);
    list.AddCircleFilled({entry.x, y + look::px(7.0F)}, look::px(4.0F), entry.colour);
    list.AddText(fonts.small, size, {entry.x + beside_dot, y}, look::kDim, entry.what);
  }
}

}  // namespace

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

struct ModelView::State {
  unsigned program = make_program("models", kVertexShader, kFragmentShader);
  unsigned framebuffer = 0, colour = 0, depth = 0;
  int width_px = 0, height_px = 0;
  bool is_stale = true;
  Orbit orbit;
  bool is_placed = false;  ///< the orbit was set to show the room
  std::shared_ptr<const Mesh> room;
  DrawnMesh drawn_room, drawn_seen, drawn_inferred;
  std::map<std::shared_ptr<const Mesh>, std::unique_ptr<DrawnMesh>> drawn_objects;

  void fit(int wanted_width_px, int wanted_height_px) {
    if (wanted_width_px == width_px && wanted_height_px == height_px) return;
    width_px = wanted_width_px;
    height_px = wanted_height_px;
    if (framebuffer == 0) {
      glGenFramebuffers(1, &framebuffer);
      glGenTextures(1, &colour);
      glGenRenderbuffers(1, &depth);
    }
    glBindTexture(GL_TEXTURE_2D, colour);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_px, height_px);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    is_stale = true;
  }
  ~State() {
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &colour);
    glDeleteRenderbuffers(1, &depth);
    glDeleteProgram(program);
  }
};

ModelView::ModelView() : state_(std::make_unique<State>()) {}
ModelView::~ModelView() = default;

void ModelView::upload(const Snapshot& shown) {
  State& state = *state_;
  state.is_stale = true;
  if (shown.room && shown.room != state.room) {
    state.room = shown.room;
    state.drawn_room.upload(*shown.room, GL_STATIC_DRAW);
    const Eigen::AlignedBox3d box = bounds_of(*shown.room);
    if (!state.is_placed && !box.isEmpty()) {
      state.is_placed = true;
      state.orbit.target_world = box.center();
      state.orbit.distance_m = std::clamp(1.1 * box.diagonal().norm(), 1.0, 30.0);
      // From behind the camera and beside it, to its target, so left and right match the picture.
      if (shown.view) {
        const Eigen::Vector3d back = -shown.view->T_world_view.linear().col(2);
        state.orbit.azimuth_rad = std::atan2(back.y(), back.x()) + 0.45;
        state.orbit.target_world = shown.view->T_world_view.translation() - kLookedAt_m * back;
        state.orbit.distance_m = 2.6 * kLookedAt_m;
      }
    }
  }
  state.drawn_seen.upload(shown.seen_world, GL_STREAM_DRAW);
  state.drawn_inferred.upload(shown.inferred_world, GL_STREAM_DRAW);
  for (const ShownObject& object : shown.objects) {
    auto& drawn = state.drawn_objects[object.mesh];
    if (drawn) continue;
    drawn = std::make_unique<DrawnMesh>();
    drawn->upload(*object.mesh, GL_STATIC_DRAW);
  }
}

void ModelView::look_at_chosen(const Snapshot& shown) {
  for (const ShownObject& object : shown.objects) {
    if (object.name != shown.chosen || !object.in_room) continue;
    state_->orbit.target_world = object.T_world_object * object.box.center();
    state_->orbit.distance_m = std::clamp(5.0 * object.box.diagonal().norm(), 0.4, 5.0);
    state_->is_stale = true;
  }
}

void ModelView::steer(const Area& area) {
  Orbit& orbit = state_->orbit;
  const ImGuiIO& io = ImGui::GetIO();
  const double dx = io.MouseDelta.x, dy = io.MouseDelta.y;
  const bool turns = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && !io.KeyShift;
  const bool shifts = ImGui::IsItemActive() && !turns;
  if (turns && (dx != 0.0 || dy != 0.0)) {
    orbit.azimuth_rad -= 0.008 * dx;
    orbit.elevation_rad = std::clamp(orbit.elevation_rad + 0.008 * dy, -1.55, 1.55);
    state_->is_stale = true;
  }
  if (shifts && (dx != 0.0 || dy != 0.0)) {
    const double m_per_px =
        2.0 * orbit.distance_m * std::tan(0.5 * kFieldOfView_rad) / static_cast<double>(area.height);
    const Eigen::Matrix3d R_world_eye = eye_of(orbit).linear();
    orbit.target_world += m_per_px * (-dx * R_world_eye.col(0) + dy * R_world_eye.col(1));
    state_->is_stale = true;
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0F) {
    orbit.distance_m =
        std::clamp(orbit.distance_m * std::pow(0.88, static_cast<double>(io.MouseWheel)), 0.1, 40.0);
    state_->is_stale = true;
  }
}

void ModelView::render(int width_px, int height_px, const Snapshot& shown) {
  State& state = *state_;
  state.fit(width_px, height_px);
  if (!state.is_stale) return;
  state.is_stale = false;
  glBindFramebuffer(GL_FRAMEBUFFER, state.framebuffer);
  glViewport(0, 0, width_px, height_px);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glClearColor(0.063F, 0.075F, 0.094F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(state.program);
  const Eigen::Isometry3d T_eye_world = eye_of(state.orbit).inverse();
  const Eigen::Matrix4d clip_from_eye = perspective(static_cast<double>(width_px) / height_px);
  const Eigen::Vector3f up = T_eye_world.linear().col(2).cast<float>();
  glUniform3fv(glGetUniformLocation(state.program, "up_eye"), 1, up.data());
  const auto draw = [&](const DrawnMesh& mesh, const Eigen::Isometry3d& T_world_mesh,
                        const std::array<float, 3>& plain, float plainness) {
    if (mesh.index_count == 0) return;
    const Eigen::Matrix4d eye = (T_eye_world * T_world_mesh * Eigen::Translation3d(mesh.origin)).matrix();
    const Eigen::Matrix4f eye_float = eye.cast<float>();
    const Eigen::Matrix4f clip_float = (clip_from_eye * eye).cast<float>();
    glUniformMatrix4fv(glGetUniformLocation(state.program, "clip_from_local"), 1, GL_FALSE,
                       clip_float.data());
    glUniformMatrix4fv(glGetUniformLocation(state.program, "eye_from_local"), 1, GL_FALSE, eye_float.data());
    glUniform4f(glGetUniformLocation(state.program, "plain"), plain[0], plain[1], plain[2],
                mesh.has_colours ? plainness : 1.0F);
    glBindVertexArray(mesh.vertex_array);
    glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
  };
  const Eigen::Isometry3d at_home = Eigen::Isometry3d::Identity();
  glEnable(GL_CULL_FACE);  // walls are transparent from outside
  draw(state.drawn_room, at_home, {0.62F, 0.66F, 0.72F}, 0.25F);
  glDisable(GL_CULL_FACE);
  draw(state.drawn_inferred, at_home, {0.55F, 0.36F, 0.62F}, 1.0F);
  draw(state.drawn_seen, at_home, {0.93F, 0.45F, 0.40F}, 0.85F);
  for (const ShownObject& object : shown.objects) {
    if (!object.in_room) continue;
    draw(*state.drawn_objects.at(object.mesh), object.T_world_object,
         object.name == shown.chosen ? std::array<float, 3>{0.25F, 0.77F, 0.67F}
                                     : std::array<float, 3>{0.78F, 0.47F, 0.28F},
         1.0F);
  }
  glBindVertexArray(0);
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void ModelView::draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts) {
  look::begin_pane("models", area, look::kGround);
  const int width_px = static_cast<int>(area.width), height_px = static_cast<int>(area.height);
  ImGui::SetCursorScreenPos({area.x, area.y});
  ImGui::InvisibleButton("orbit", {area.width, area.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  steer(area);
  render(width_px, height_px, shown);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddImage(reinterpret_cast<void*>(static_cast<std::uintptr_t>(state_->colour)), {area.x, area.y},
                {area.x + area.width, area.y + area.height}, {0.0F, 1.0F}, {1.0F, 0.0F});  // GL's rows go up
  const Eigen::Isometry3d T_eye_world = eye_of(state_->orbit).inverse();
  const Eigen::Matrix4d clip_from_eye = perspective(static_cast<double>(width_px) / height_px);
  const ToWindow to_window = [&](const Eigen::Vector3d& p_world) -> std::optional<ImVec2> {
    const Eigen::Vector3d p_eye = T_eye_world * p_world;
    if (p_eye.z() > -kNear_m) return std::nullopt;
    const Eigen::Vector4d clip = clip_from_eye * p_eye.homogeneous();
    return ImVec2(area.x + area.width * static_cast<float>(0.5 + 0.5 * clip.x() / clip.w()),
                  area.y + area.height * static_cast<float>(0.5 - 0.5 * clip.y() / clip.w()));
  };
  if (shown.view) draw_camera(list, *shown.view, 0.45, to_window);
  draw_target_volume(list, shown.shown_radar, to_window, fonts);
  draw_legend(list, area, fonts);
  look::end_pane();
}

}  // namespace roomradar
