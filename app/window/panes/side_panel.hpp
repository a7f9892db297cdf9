// side_panel.hpp: panel with controls for objects, policies and radar.
#pragma once
#include <string>
#include <vector>

#include "app/objects/object_file.hpp"
#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// The user's settings for future commands. Not part of the session.
struct PlaySettings {
  float drop_height_m = 0.3F;
  float throw_speed_mps = 3.0F;
  float new_size_m = 0.0F;           ///< size of an added object; 0: that of its ObjectSource
  std::vector<ObjectSource> meshes;  ///< objects that can be added: `teapot` and files
  std::size_t mesh = 0;
  int radar_px = 64;  ///< value of the radar's resolution slider while it is dragged
  /// Values of the chosen object's material sliders while one is dragged: kg, coefficients.
  float mass_kg = 1.0F, friction = 0.5F, restitution = 0.0F;
};

void draw_side_panel(const Area& area, const Snapshot& shown, UiChannel& link, PlaySettings& settings,
                     const look::Fonts& fonts);

/// Returns the command that adds an object with the mesh and size in `settings`.
UserCommand new_object_command(const PlaySettings& settings);
/// Return commands that change a policy. Used by keys and panels.
UserCommand surfaces_command(SurfacePolicy surfaces);
UserCommand unknown_command(bool is_solid);
UserCommand radar_command(const RadarConfig& radar);
UserCommand camera_command(CameraPlay camera);
/// Returns the command that changes an object's material.
UserCommand material_command(const std::string& object, const BodyMaterial& change);

}  // namespace roomradar
