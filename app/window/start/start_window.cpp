// start_window.cpp: shows the start view.
#include "app/window/start/start_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "app/window/glfw_window.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/start/start_ui.hpp"

namespace roomradar {
namespace {

constexpr const char* kTitle = "roomradar";

}  // namespace

StartWindow::StartWindow() : window_(open_window(kTitle)) {}

StartChoice StartWindow::show(StartState& state) {
  open_window(kTitle);  // the title may be that of a scan, and the window hidden
  StartChoice choice;
  show_until_closed(*window_, state.settings.ui_scale, [&](const look::Fonts& fonts) {
    return std::make_unique<StartUi>(state, choice, fonts, [] { glfwPostEmptyEvent(); });
  });
  return choice;
}

bool StartWindow::was_closed() const { return glfwWindowShouldClose(window_->get()) == GLFW_TRUE; }

}  // namespace roomradar
