// model_view.hpp: the models in three dimensions: room, what moved, objects, camera and target volume.
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <memory>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// An eye that goes round a point. Angles in radians; azimuth about +z, elevation above level.
struct Orbit {
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  double azimuth_rad = 0.8;
  double elevation_rad = 0.7;
  double distance_m = 4.0;
};
/// The eye's pose: x right, y up, it looks along -z (OpenGL's).
Eigen::Isometry3d eye_of(const Orbit& orbit);

/// Draws into a texture of its own, and only when something has changed: on a machine without a GPU a room of
/// half a million triangles takes some ten milliseconds. The window's context must be current.
class ModelView {
 public:
  ModelView();
  ~ModelView();
  ModelView(const ModelView&) = delete;
  ModelView& operator=(const ModelView&) = delete;

  void upload(const Snapshot& shown);
  void draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts);
  /// Looks at the chosen object.
  void look_at_chosen(const Snapshot& shown);

 private:
  struct State;
  std::unique_ptr<State> state_;

  void steer(const Area& area);
  void render(int width_px, int height_px, const Snapshot& shown);
};

}  // namespace roomradar
