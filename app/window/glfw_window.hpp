// glfw_window.hpp: a window of the desktop with an OpenGL context, and what the user does to it.
#pragma once
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace roomradar {

struct Key {
  int key = 0;             ///< as key_meant() says
  int modifiers = 0;       ///< as they were when it was pressed
  bool is_repeat = false;  ///< it has been held down for a while
};

/// GLFW's window with a current context. Keys that are pressed in it, and files that are dropped onto it, are
/// kept until they are taken. One at a time, on the main thread.
class GlfwWindow {
 public:
  /// @throws Error saying what to do where there is no display, or it gives no OpenGL 3.3
  explicit GlfwWindow(const std::string& title);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  [[nodiscard]] GLFWwindow* get() const { return window_; }
  std::vector<Key> take_keys() { return std::exchange(keys_, {}); }
  std::vector<std::string> take_files() { return std::exchange(files_, {}); }

 private:
  GLFWwindow* window_ = nullptr;
  std::vector<Key> keys_;
  std::vector<std::string> files_;
};

}  // namespace roomradar
