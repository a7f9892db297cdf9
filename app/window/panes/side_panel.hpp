// side_panel.hpp: objects, policies, radar: what a user chooses.
#pragma once
#include <string>
#include <vector>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// How the user plays; none of it is the session's.
struct PlaySettings {
  float drop_height_m = 0.3F;
  float throw_speed_mps = 3.0F;
  float new_size_m = 0.0F;          ///< of an added object; 0: as its mesh is
  std::vector<std::string> meshes;  ///< that can be added: `teapot`, and files
  std::size_t mesh = 0;
  int radar_px = 64;  ///< while it is being dragged
};

void draw_side_panel(const Area& area, const Snapshot& shown, UiChannel& link, PlaySettings& settings,
                     const look::Fonts& fonts);

/// One more of the mesh and size that the settings say.
UserCommand new_object_command(const PlaySettings& settings);
/// The events that change a policy, for keys and panels alike.
UserCommand surfaces_command(SurfacePolicy surfaces);
UserCommand unknown_command(bool is_solid);
UserCommand radar_command(const RadarConfig& radar);
UserCommand camera_command(CameraPlay camera);

}  // namespace roomradar
