// glfw_window.cpp: opens the window and stores its events.
#include "app/window/glfw_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>

#include "app/window/link/key_meant.hpp"
#include "app/window/panes/window_layout.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {
namespace {

constexpr int kWidth_px = 1280, kHeight_px = 800;

std::string last_glfw_error() {
  const char* what = nullptr;
  glfwGetError(&what);
  return what != nullptr ? what : "no reason was given";
}

/// Returns the window's first size, which fits a small screen.
std::array<int, 2> first_size_px() {
  int x = 0, y = 0, width_px = kWidth_px, height_px = kHeight_px;
  if (GLFWmonitor* screen = glfwGetPrimaryMonitor())
    glfwGetMonitorWorkarea(screen, &x, &y, &width_px, &height_px);
  return {std::clamp(width_px, kLeastWidth_px, kWidth_px),
          std::clamp(height_px, kLeastHeight_px, kHeight_px)};
}

}  // namespace

GlfwWindow::GlfwWindow(const std::string& title) {
  if (glfwInit() != GLFW_TRUE) {
    const std::string fault = last_glfw_error();
    const char* display = std::getenv("DISPLAY");
    throw Error(
        "there is no display to open a window on (" + fault +
        (display == nullptr ? "; DISPLAY is not set" : std::string("; DISPLAY is ") + display) +
        "). Over ssh connect with ssh -X, or leave --window out; `run --video FILE.mp4` writes what its "
        "window would show");
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "roomradar");  // StartupWMClass of the desktop entry
  glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "roomradar");
  // EGL if it works, as for the radar, so the process loads one driver; else the window system's own API.
  const auto [width_px, height_px] = first_size_px();
  const std::set<pid_t> threads_before = threads_of_process();
  for (const int way : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, way);
    window_ = glfwCreateWindow(width_px, height_px, title.c_str(), nullptr, nullptr);
    if (window_ != nullptr) break;
  }
  if (window_ == nullptr) {
    const std::string fault = last_glfw_error();
    glfwTerminate();
    throw Error("the display gives no window with OpenGL 3.3 (" + fault +
                "); leave --window out; `run --video FILE.mp4` writes what its window would show");
  }
  glfwSetWindowSizeLimits(window_, kLeastWidth_px, kLeastHeight_px, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(window_);
  // Those of a renderer on the processor. Tracking and play do not wait for the drawing.
  for (const pid_t thread : threads_of_process())
    if (!threads_before.contains(thread)) lower_priority(thread);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    if (action == GLFW_RELEASE) return;
    const int meant = key_meant(key, glfwGetKeyName(key, scancode));
    static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window))
        ->keys_.push_back({meant, modifiers, action == GLFW_REPEAT});
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    auto& files = static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window))->files_;
    files.insert(files.end(), paths, paths + count);
  });
}

GlfwWindow::~GlfwWindow() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

std::shared_ptr<GlfwWindow> open_window(const std::string& title) {
  static std::weak_ptr<GlfwWindow> open;
  std::shared_ptr<GlfwWindow> window = open.lock();
  if (!window) {
    window = std::make_shared<GlfwWindow>(title);
    open = window;
    return window;
  }
  glfwSetWindowTitle(window->get(), title.c_str());
  glfwSetWindowShouldClose(window->get(), GLFW_FALSE);
  glfwShowWindow(window->get());
  return window;
}

}  // namespace roomradar
