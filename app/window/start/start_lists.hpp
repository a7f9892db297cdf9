// start_lists.hpp: draws the lists of sources and maps, and the chosen entry.
#pragma once
#include "app/start/start_state.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"
#include "app/window/start/examined_maps.hpp"

namespace roomradar {

/// Draws the list of sources. A click chooses a row and makes the list active.
/// @param scrolls_to_choice  true: the chosen row is scrolled into view
void draw_sources(const Area& area, StartState& state, const look::Fonts& fonts, bool scrolls_to_choice);
/// Draws the list of maps in the same way.
void draw_maps(const Area& area, StartState& state, const ExaminedMaps& examined, const look::Fonts& fonts,
               bool scrolls_to_choice);
/// Draws picture and facts of the chosen map, or the chosen source, whichever list is active.
void draw_detail(const Area& area, const StartState& state, const ExaminedMaps& examined,
                 const look::Fonts& fonts);

}  // namespace roomradar
