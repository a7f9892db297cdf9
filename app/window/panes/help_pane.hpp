// help_pane.hpp: lists the mouse actions and keys over all other panes.
#pragma once
#include "app/window/panes/theme.hpp"

namespace roomradar {

/// Draws the list over a window of this size. Returns true if the user clicked to close it.
bool draw_help(float width, float height, const look::Fonts& fonts);

}  // namespace roomradar
