// scan_window_absent.cpp: replaces scan_window.cpp in builds without GLFW or Dear ImGui.
#include "app/window/scan/scan_window.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

ScanWindowResult run_in_scan_window(const std::string& /*title*/, std::optional<double> /*ui_scale*/,
                                    LostSignal /*lost_signal*/,
                                    const std::function<int(ScanChannel&)>& /*work*/) {
  throw Error(
      "--window: this roomradar was built without it; install libglfw3-dev and libimgui-dev and configure "
      "again, or scan without it");
}

}  // namespace roomradar
