// start_window_absent.cpp: replaces start_window.cpp in builds without GLFW or Dear ImGui.
#include "app/window/start/start_window.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

StartWindow::StartWindow() {
  throw Error(
      "this roomradar was built without a window; install libglfw3-dev and libimgui-dev and configure again, "
      "or "
      "use the commands");
}

StartChoice StartWindow::show(StartState& /*state*/) { return {}; }

bool StartWindow::was_closed() const { return true; }

}  // namespace roomradar
