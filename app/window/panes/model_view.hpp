// model_view.hpp: 3D view of room, dynamic foreground, objects, camera, and the box that the radar searched.
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <memory>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// Orbiting eye. Azimuth is about +z, elevation is above the horizontal plane.
struct Orbit {
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  double azimuth_rad = 0.8;
  double elevation_rad = 0.7;
  double distance_m = 4.0;
};
/// Returns the eye's pose: x right, y up, looking along -z (OpenGL).
Eigen::Isometry3d eye_of(const Orbit& orbit);

/// Renders into a texture, and only when something has changed: without a GPU, a room of half a million
/// triangles takes tens of milliseconds. The window's context must be current.
class ModelView {
 public:
  ModelView();
  ~ModelView();
  ModelView(const ModelView&) = delete;
  ModelView& operator=(const ModelView&) = delete;

  void upload(const Snapshot& shown);
  void draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts);
  /// Turns the view to the chosen object.
  void look_at_chosen(const Snapshot& shown);

 private:
  struct State;
  std::unique_ptr<State> state_;

  void steer(const Area& area);
  void render(int width_px, int height_px, const Snapshot& shown);
};

}  // namespace roomradar
