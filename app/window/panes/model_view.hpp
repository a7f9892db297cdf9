// model_view.hpp: 3D view of room, dynamic foreground, objects, camera, and the radar's target volume.
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <memory>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

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

/// Renders the view into a texture. Renders only after its content has changed. Without a GPU, a room of half
/// a million triangles takes tens of milliseconds. The window's OpenGL context must be current for all calls.
class ModelView {
 public:
  ModelView();
  ~ModelView();
  ModelView(const ModelView&) = delete;
  ModelView& operator=(const ModelView&) = delete;

  void upload(const Snapshot& shown);
  void draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts);
  /// Makes the chosen object the target of the view.
  void look_at_chosen(const Snapshot& shown);

 private:
  struct State;
  std::unique_ptr<State> state_;

  void steer(const Area& area);
  void render(int width_px, int height_px, const Snapshot& shown);
};

}  // namespace roomradar
