// radar_pane.hpp: R, M and L of the chosen object as pictures.
#pragma once
#include "app/window/gl_texture.hpp"
#include "app/window/look.hpp"
#include "app/window/play_link.hpp"
#include "app/window/window_layout.hpp"

namespace roomradar {

class RadarPane {
 public:
  void upload(const ShownRadar& radar);
  void draw(const Area& area, const ShownRadar& radar, const look::Fonts& fonts);

 private:
  GlTexture range_{false}, mask_{false}, lookat_{false};
  ColourImage coloured_;
  int least_x_ = -1, least_y_ = -1;  ///< the pixel of min L
  float least_m_ = 0.0F;
};

}  // namespace roomradar
