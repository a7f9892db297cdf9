// start_panes.hpp: the parts of the start view: lists, buttons, questions and notices.
#pragma once
#include <imgui.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/start/start_state.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"
#include "app/window/start/examined_maps.hpp"

namespace roomradar {

// Draws the lists of sources and maps, and the chosen entry.

/// Draws the list of sources. A click chooses a row and makes the list active.
/// @param scrolls_to_choice  true: the chosen row is scrolled into view
void draw_sources(const Area& area, StartState& state, const look::Fonts& fonts, bool scrolls_to_choice);
/// Draws the list of maps in the same way.
void draw_maps(const Area& area, StartState& state, const ExaminedMaps& examined, const look::Fonts& fonts,
               bool scrolls_to_choice);
/// Draws picture and facts of the chosen map, or the chosen source, whichever list is active.
void draw_detail(const Area& area, const StartState& state, const ExaminedMaps& examined,
                 const look::Fonts& fonts);

// The start view's buttons, and their keys.

/// Draws the buttons, in two rows if one row is too narrow, and the names of the keys for moving in the
/// lists. Buttons of unavailable actions are dimmed. Returns the action that was clicked.
std::optional<StartAction> draw_action_bar(const Area& area, const StartState& state,
                                           const look::Fonts& fonts);

/// Returns the action of a key.
/// @param key  result of key_meant()
std::optional<StartAction> action_of_key(int key);

/// Returns the action of the Enter key: Scan in the list of sources, Play in that of maps.
StartAction first_action(const StartState& state);

// Questions and notices over the start view.

/// kNone: no answer yet. kPage, kGlb, kPly: the format chosen in kExport.
enum class DialogAnswer { kNone, kYes, kNo, kPage, kGlb, kPly };

enum class DialogKind {
  kNone,
  kNewMap,   ///< asks for the name of a new map
  kRename,   ///< asks for the new name of a map
  kDelete,   ///< asks before a map is deleted
  kExport,   ///< asks for a format
  kCompare,  ///< asks for the second map
  kNotice,   ///< informs; has only a Close button
};

struct DialogLine {
  std::string text;
  ImU32 colour = look::kText;
};

struct StartDialog {
  DialogKind kind = DialogKind::kNone;
  std::string heading;
  std::vector<DialogLine> lines;
  std::array<char, 256> name{};      ///< text of kNewMap and kRename, null-terminated
  std::string fault;                 ///< sentence on why the name was refused; empty: none
  std::vector<std::string> choices;  ///< rows of kCompare
  int choice = 0;                    ///< chosen row of kCompare
  /// Answer of a key that was pressed while the name is edited. draw_dialog() returns it once the text field
  /// has processed the typed text.
  DialogAnswer pressed = DialogAnswer::kNone;
  bool is_new = true;  ///< true: the text field gets the keyboard focus when it is drawn
};

/// Draws the dialog over a dimmed window. Returns the answer of a click or, while the name is edited, of a
/// key.
DialogAnswer draw_dialog(float width, float height, StartDialog& dialog, const look::Fonts& fonts);

/// Returns the answer of a key that was pressed while the dialog is open. Moves
/// StartDialog::choice by the arrow keys.
/// @param key  result of key_meant()
DialogAnswer answer_of_key(int key, StartDialog& dialog);

}  // namespace roomradar
