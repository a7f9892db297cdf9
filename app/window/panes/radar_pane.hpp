// radar_pane.hpp: shows the radar's R, M and L images of the chosen object (see RadarPictures).
#pragma once
#include <string>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/gl_texture.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

class RadarPane {
 public:
  void upload(const ShownRadar& radar);
  void draw(const Area& area, const ShownRadar& radar, const look::Fonts& fonts);

 private:
  /// Returns a text with the distance to contact, and with R, M and L at pixel (x, y) if the images contain
  /// it.
  [[nodiscard]] std::string numbers_at(const ShownRadar& radar, int x, int y) const;

  GlTexture range_{false}, mask_{false}, lookat_{false};
  ColourImage coloured_;
  int least_x_ = -1, least_y_ = -1;  ///< pixel with the smallest L; -1: none
  float least_m_ = 0.0F;
};

}  // namespace roomradar
