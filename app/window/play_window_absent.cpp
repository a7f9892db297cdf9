// play_window_absent.cpp: replaces play_window.cpp in builds without GLFW or Dear ImGui.
#include "app/window/play_window.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

PlayWindowResult run_in_window(const std::string& /*title*/, const std::vector<ObjectSource>& /*meshes*/,
                               std::optional<double> /*budget_ms*/, std::optional<double> /*ui_scale*/,
                               const std::function<int(UiChannel&)>& /*work*/) {
  throw Error(
      "--window: this roomradar was built without it; install libglfw3-dev and libimgui-dev and configure "
      "again, or write the pictures with --video FILE");
}

}  // namespace roomradar
