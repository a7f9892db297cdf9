// orbit_canvas.hpp: renders meshes, seen by an orbiting eye, into a texture of the window.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include "app/window/panes/annotate.hpp"
#include "app/window/panes/window_layout.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A mesh in the window's OpenGL context, which must be current for all calls.
class DrawnMesh {
 public:
  DrawnMesh();
  ~DrawnMesh();
  DrawnMesh(const DrawnMesh&) = delete;
  DrawnMesh& operator=(const DrawnMesh&) = delete;

  /// @param changes_often  true: the mesh is replaced every few frames
  void upload(const Mesh& mesh, bool changes_often);
  /// Adds a texture to the uploaded mesh, in place of colours. Removes it if there are no points.
  /// @param points  one per vertex; (0, 0) is the texture's top left corner, (1, 1) its bottom right corner
  void upload_texture(const std::vector<Eigen::Vector2f>& points, const ColourImage& texture);

 private:
  friend class OrbitCanvas;
  unsigned vertex_array_ = 0;
  std::array<unsigned, 4> buffers_{};  // positions, colours, indices, texture points
  unsigned texture_ = 0;               // 0: none
  int index_count_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  bool has_colours_ = false;
};

/// Position of an eye that orbits a target. Azimuth is the angle about +z, elevation the angle above the
/// horizontal plane.
struct Orbit {
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  double azimuth_rad = 0.8;
  double elevation_rad = 0.7;
  double distance_m = 4.0;
};
/// Returns the eye's pose: x right, y up, looking along -z (OpenGL).
Eigen::Isometry3d eye_of(const Orbit& orbit);

/// Colour of a mesh without colours; it is mixed into the colours of other meshes with weight `fraction`.
/// Shading is weaker for a textured mesh, since the texture already contains the room's light.
struct Tint {
  std::array<float, 3> rgb{};
  float fraction = 1.0F;
};

/// A texture that meshes are drawn into. The window's OpenGL context must be current for all calls.
class OrbitCanvas {
 public:
  OrbitCanvas();
  ~OrbitCanvas();
  OrbitCanvas(const OrbitCanvas&) = delete;
  OrbitCanvas& operator=(const OrbitCanvas&) = delete;

  Orbit orbit;

  /// Handles the mouse in the area: a left drag turns, a right drag (or left with Shift) shifts, the wheel
  /// zooms. Call within a Dear ImGui frame, after the window's pane has begun. Returns true if the orbit has
  /// changed.
  bool steer(const Area& area);

  /// Reports that the drawn content has changed. The view is rendered again when must_render() returns true.
  void content_changed() { is_stale_ = true; }
  /// Reports that `orbit` has changed. The view is rendered again at once. steer() calls it.
  void orbit_changed() { is_moved_ = true; }
  /// Returns true if the view must be rendered now, by begin(), draw() and end(). Returns true immediately
  /// after a change of the orbit or of the size in pixels. After a change of the content, returns true once 7
  /// times the last rendering's duration, at most 0.2 s, has passed since that rendering. The delay leaves
  /// processor time to other threads, since a software renderer uses the CPU.
  bool must_render(int width_px, int height_px);
  void begin();
  /// @param is_transparent_behind  true: triangles that face away from the eye are not drawn
  void draw(const DrawnMesh& mesh, const Eigen::Isometry3d& T_world_mesh, const Tint& tint,
            bool is_transparent_behind = false);
  void end();

  /// Adds the texture to the window's drawing, over the area. The canvas must exist until the window is
  /// drawn.
  void show(const Area& area);
  /// Returns the projection of world points to the window, if the texture covers the area.
  [[nodiscard]] ToWindow to_window(const Area& area) const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_{}, due_{};  ///< begin of the last rendering; earliest time of the next one
  bool is_stale_ = true, is_moved_ = false;
  unsigned program_ = 0, framebuffer_ = 0, colour_ = 0, depth_ = 0;
  int width_px_ = 0, height_px_ = 0;
  Eigen::Isometry3d T_eye_world_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix4d clip_from_eye_ = Eigen::Matrix4d::Identity();
  Area shown_at_{};

  bool fit(int width_px, int height_px);
  void copy_to_window() const;
};

/// Returns the bounding box of a mesh in the world frame; empty if the mesh has no vertices.
Eigen::AlignedBox3d bounds_of(const Mesh& mesh);

}  // namespace roomradar
