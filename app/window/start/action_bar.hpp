// action_bar.hpp: the start view's buttons, and their keys.
#pragma once
#include <optional>

#include "app/start/start_state.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// Draws the buttons, in two rows if one row is too narrow, and the names of the keys for moving in the
/// lists. Buttons of unavailable actions are dimmed. Returns the action that was clicked.
std::optional<StartAction> draw_action_bar(const Area& area, const StartState& state,
                                           const look::Fonts& fonts);

/// Returns the action of a key.
/// @param key  result of key_meant()
std::optional<StartAction> action_of_key(int key);

/// Returns the action of the Enter key: Scan in the list of sources, Play in that of maps.
StartAction first_action(const StartState& state);

}  // namespace roomradar
