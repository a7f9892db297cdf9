// play_window.hpp: the window of `roomradar run --window`.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/window/link/ui_channel.hpp"

namespace roomradar {

/// Opens a window, runs `work` on a thread of its own, and shows what it publishes until the user closes the
/// window or the work is over and the window is closed. Must be called on the main thread.
///
/// @param title      of the window
/// @param meshes     that can be added beside the built-in teapot: files that read_mesh reads
/// @param budget_ms  of a frame, where it is held to one
/// @return what `work` returned; what it throws is thrown here
/// @throws Error saying what to do where this build has no window, there is no display, or the display gives
///         no OpenGL 3.3
int run_in_window(const std::string& title, const std::vector<std::string>& meshes,
                  std::optional<double> budget_ms, const std::function<int(UiChannel&)>& work);

}  // namespace roomradar
