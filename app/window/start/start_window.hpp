// start_window.hpp: window of `roomradar start`, or of `roomradar` without arguments.
#pragma once
#include <memory>

#include "app/start/start_state.hpp"

namespace roomradar {

class GlfwWindow;

/// The window of the start view. The window remains open while a scan or run uses it through open_window().
class StartWindow {
 public:
  /// Opens the window. Call on the main thread.
  /// @throws Error with advice if the program was built without a window, or if there is no display with
  ///         OpenGL 3.3
  StartWindow();

  /// Shows the start view until the user chooses an action; StartAction::kQuit if the window is closed.
  /// Changes lists, choice and settings in `state`.
  StartChoice show(StartState& state);
  /// Returns true if the user closed the window since show().
  [[nodiscard]] bool was_closed() const;

 private:
  std::shared_ptr<GlfwWindow> window_;
};

}  // namespace roomradar
