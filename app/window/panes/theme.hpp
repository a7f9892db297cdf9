// look.hpp: the window's colours, letters and small parts.
#pragma once
#include <imgui.h>

#include <string>

#include "app/window/panes/window_layout.hpp"

namespace roomradar::look {

inline constexpr ImU32 kGround = IM_COL32(16, 19, 24, 255);
inline constexpr ImU32 kPanel = IM_COL32(24, 28, 35, 255);
inline constexpr ImU32 kRaised = IM_COL32(38, 44, 54, 255);
inline constexpr ImU32 kLine = IM_COL32(48, 55, 67, 255);
inline constexpr ImU32 kText = IM_COL32(222, 228, 236, 255);
inline constexpr ImU32 kDim = IM_COL32(134, 145, 160, 255);
inline constexpr ImU32 kAccent = IM_COL32(64, 196, 172, 255);
inline constexpr ImU32 kGood = IM_COL32(96, 200, 120, 255);
inline constexpr ImU32 kWarn = IM_COL32(240, 178, 74, 255);
inline constexpr ImU32 kBad = IM_COL32(235, 92, 92, 255);

struct Fonts {
  ImFont* text = nullptr;
  ImFont* small = nullptr;
  ImFont* large = nullptr;
};

/// Sets Dear ImGui's style and loads letters: DejaVu where it is installed, else its own.
Fonts apply(float scale);

/// Pixels of a length that was thought for a screen of 96 dpi, with the scale of apply().
float px(float length);

/// A pane that fills an area, without a title or a border of its own. Always to be followed by end_pane().
bool begin_pane(const char* name, const Area& area, ImU32 ground = kPanel, bool scrolls = false);
void end_pane();

/// A small heading of a group.
void heading(const char* text, const Fonts& fonts);

/// A button that may be lit; `key` is shown dim behind the text.
bool button(const char* label, const char* key, bool is_lit, ImVec2 size = {0, 0}, bool enabled = true);

/// One of several words; returns the index that was clicked, or -1.
int segments(const char* id, const char* const* words, int count, int lit);

/// A dot and a word.
void pill(ImU32 colour, const std::string& text);

}  // namespace roomradar::look
