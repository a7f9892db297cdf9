// help_pane.hpp: list of the mouse actions and keys, drawn over all other panes.
#pragma once
#include "app/window/panes/theme.hpp"

namespace roomradar {

/// Draws the list over a window of this size. Returns true if the user has closed the list with a click.
bool draw_help(float width, float height, const look::Fonts& fonts);

}  // namespace roomradar
