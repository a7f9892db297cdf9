// play_window.cpp: shows the window, and runs the session on another thread.
//
// The window's OpenGL context shares nothing with the radar's. Contexts share objects only on one EGL
// display; the radar's is a device display without a window system, to be the same with and without a window,
// while the window's is X11's. Nothing is lost: the picture is composed in main memory for videos and reports
// anyway, and is uploaded as a texture of 0.9 MB in some 0.2 ms. Two contexts also let the session run on
// another thread.
#include "app/window/play_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "app/cli/interrupt.hpp"
#include "app/window/glfw_window.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/play_ui.hpp"

namespace roomradar {

PlayWindowResult run_in_window(const std::string& title, const std::vector<ObjectSource>& meshes,
                               std::optional<double> budget_ms, std::optional<double> ui_scale,
                               const std::function<int(UiChannel&)>& work) {
  const std::shared_ptr<GlfwWindow> open = open_window(title);
  GlfwWindow& window = *open;
  UiChannel link([] { glfwPostEmptyEvent(); });
  PlayWindowResult result;
  std::exception_ptr fault;
  std::thread session([&] {
    try {
      result.status = work(link);
    } catch (...) {
      fault = std::current_exception();
    }
    if (fault || Interrupt::was_pressed())
      glfwSetWindowShouldClose(window.get(), GLFW_TRUE);  // allowed on any thread
    link.finish();
  });
  try {
    show_until_closed(window, ui_scale, [&](const look::Fonts& fonts) {
      return std::make_unique<PlayUi>(link, fonts, meshes, budget_ms);
    });
  } catch (...) {
    link.close();
    session.join();
    throw;
  }
  link.close();
  result.wants_to_scan = link.wants_to_scan();
  if (!result.wants_to_scan) glfwHideWindow(window.get());  // the session may take a while to end
  session.join();
  if (fault) glfwSetWindowShouldClose(window.get(), GLFW_FALSE);  // the fault closed it, not the user
  if (fault) std::rethrow_exception(fault);
  if (result.wants_to_scan) result.window = open;
  return result;
}

}  // namespace roomradar
