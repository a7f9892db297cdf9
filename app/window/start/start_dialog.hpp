// start_dialog.hpp: questions and notices over the start view.
#pragma once
#include <imgui.h>

#include <array>
#include <string>
#include <vector>

#include "app/window/panes/theme.hpp"

namespace roomradar {

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
