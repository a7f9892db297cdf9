// glfw_window.hpp: desktop window with an OpenGL context, and its keys and dropped files.
#pragma once
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace roomradar {

struct Key {
  int key = 0;             ///< as returned by key_meant()
  int modifiers = 0;       ///< when it was pressed; GLFW's bits
  bool is_repeat = false;  ///< generated while it is held down
};

/// GLFW window with a current context. Key presses and dropped files are stored until taken. One instance at
/// a time, on the main thread.
class GlfwWindow {
 public:
  /// @throws Error with advice if there is no display or it does not support OpenGL 3.3
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
