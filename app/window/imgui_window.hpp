// imgui_window.hpp: draws a window's content with Dear ImGui until the window is closed.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/window/glfw_window.hpp"
#include "app/window/panes/theme.hpp"

namespace roomradar {

/// Content of a window. All calls come from the window's thread.
class WindowContent {
 public:
  WindowContent() = default;
  WindowContent(const WindowContent&) = delete;
  WindowContent& operator=(const WindowContent&) = delete;
  virtual ~WindowContent() = default;

  /// Fetches state changes since the last call. Called before each draw().
  virtual void take_news() = 0;
  virtual void press(const Key& key) = 0;
  /// Called in place of press() while a text field has the keyboard focus.
  virtual void press_in_text(const Key& /*key*/) {}
  /// Called for each file that is dropped onto the window.
  virtual void take_file(const std::string& /*path*/) {}
  /// Draws within a Dear ImGui frame.
  virtual void draw(float width, float height) = 0;
  [[nodiscard]] virtual bool wants_to_quit() const = 0;
  /// Returns the scale of text and panes that the user has set in this content; unset: none.
  [[nodiscard]] virtual std::optional<double> ui_scale() const { return std::nullopt; }
};

/// Shows the content that make_content() returns, until the content wants to quit or the window is closed.
/// Draws after every event, otherwise four times a second.
/// @param ui_scale  scale of text and panes; unset: the monitor's scale, clamped to 1..3
void show_until_closed(GlfwWindow& window, std::optional<double> ui_scale,
                       const std::function<std::unique_ptr<WindowContent>(const look::Fonts&)>& make_content);

}  // namespace roomradar
