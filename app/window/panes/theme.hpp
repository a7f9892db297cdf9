// theme.hpp: colours, fonts and small widgets of the window.
#pragma once
#include <imgui.h>

#include <string>

#include "app/window/panes/window_layout.hpp"

namespace roomradar::look {

inline constexpr ImU32 kGround = IM_COL32(16, 19, 24, 255);  ///< background colour of the window
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

/// Sets Dear ImGui's style and loads the fonts: DejaVu if installed, else Dear ImGui's font.
Fonts apply(float scale);

/// Converts a length in pixels at 96 dpi to window pixels, with the scale given to apply().
float px(float length);

/// Begins a pane that fills an area, without title and border. Always call end_pane() afterwards. A pane on
/// kGround draws no background.
bool begin_pane(const char* name, const Area& area, ImU32 ground = kPanel, bool scrolls = false);
void end_pane();

/// Begins a transparent window over all panes, so that a click reaches nothing else. Always call ImGui::End()
/// afterwards.
void begin_cover(const char* name, float width, float height);

/// Draws the title of a bar, followed by a gap in window pixels.
void title(const char* text, float gap, const Fonts& fonts);

/// Draws the small heading of a group.
void heading(const char* text, const Fonts& fonts);

/// Draws small text on a dark ground, legible on any picture or plot.
void note(ImDrawList& draw, ImVec2 at, const std::string& text, ImU32 colour, const Fonts& fonts);

/// Draws a button, highlighted if is_lit. The name of its `key` follows the label in a dim colour. Returns
/// true if the button was clicked.
bool button(const char* label, const char* key, bool is_lit, ImVec2 size = {0, 0}, bool enabled = true);

/// Draws a row of buttons, with button `lit` highlighted. Returns the index of the clicked button, or -1.
int segments(const char* id, const char* const* words, int count, int lit);

/// Returns the UTF-8 text, or as much of its beginning as fits in a width in pixels, followed by an ellipsis.
std::string shortened(const std::string& text, float width);

/// Draws a coloured dot followed by a text.
void pill(ImU32 colour, const std::string& text);

}  // namespace roomradar::look
