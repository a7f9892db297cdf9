// start_layout.hpp: divides the start view into panes.
#pragma once
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

struct StartLayout {
  Area bar, sources, maps, detail, actions;
  bool has_two_rows = false;  ///< true: the actions need two rows
};

/// Returns the panes of a start view of this size: the lists at the left, the chosen entry at the right, the
/// actions below.
/// @param scale  scale of the screen; 1 at 96 dpi
constexpr StartLayout start_layout(float width, float height, float scale = 1.0F) {
  const auto whole = [](float length) { return static_cast<float>(static_cast<int>(length)); };
  StartLayout layout;
  layout.has_two_rows = width < scale * 940.0F;
  const float bar = whole(scale * 40.0F), actions = whole(scale * (layout.has_two_rows ? 96.0F : 66.0F));
  const float left = std::max(height - bar - actions, 0.0F);
  const float lists = whole(std::clamp(0.36F * width, scale * 240.0F, scale * 480.0F));
  const float sources = whole(0.5F * left);
  layout.bar = {0.0F, 0.0F, width, bar};
  layout.sources = {0.0F, bar, lists, sources};
  layout.maps = {0.0F, bar + sources, lists, left - sources};
  layout.detail = {lists, bar, width - lists, left};
  layout.actions = {0.0F, bar + left, width, actions};
  return layout;
}

}  // namespace roomradar
