// imgui_window.cpp: the window's loop: events, state changes, drawing.
#include "app/window/imgui_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "app/window/panes/window_layout.hpp"

namespace roomradar {
namespace {

struct ImGuiOfWindow {
  look::Fonts fonts;

  ImGuiOfWindow(GLFWwindow* window, std::optional<double> ui_scale) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    wanted_scale_ = ui_scale ? static_cast<float>(*ui_scale) : std::clamp(scale, 1.0F, 3.0F);
    ImGui_ImplGlfw_InitForOpenGL(window, /*install_callbacks=*/true);  // calls the callbacks installed
                                                                       // before, too
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~ImGuiOfWindow() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  ImGuiOfWindow(const ImGuiOfWindow&) = delete;
  ImGuiOfWindow& operator=(const ImGuiOfWindow&) = delete;

  void set_scale(double wanted) { wanted_scale_ = static_cast<float>(wanted); }

  /// Begins a frame, with style and fonts of the scale that the window's size allows.
  void begin_frame(GLFWwindow* window) {
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    const float scale = scale_in_window(wanted_scale_, static_cast<float>(width), static_cast<float>(height));
    if (scale != scale_) {
      ImGui_ImplOpenGL3_DestroyFontsTexture();
      ImGui::GetIO().Fonts->Clear();
      fonts = look::apply(scale);
      const bool is_first = scale_ == 0.0F;  // then the next call creates the texture
      if (!is_first) ImGui_ImplOpenGL3_CreateFontsTexture();
      scale_ = scale;
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
  }

 private:
  float wanted_scale_ = 1.0F;
  float scale_ = 0.0F;  // of style and fonts; 0: not loaded
};

}  // namespace

void show_until_closed(
    GlfwWindow& window, std::optional<double> ui_scale,
    const std::function<std::unique_ptr<WindowContent>(const look::Fonts&)>& make_content) {
  ImGuiOfWindow imgui(window.get(), ui_scale);
  const std::unique_ptr<WindowContent> content = make_content(imgui.fonts);
  constexpr double kLeastFrame_s = 1.0 / 60.0, kIdle_s = 0.25;
  while (glfwWindowShouldClose(window.get()) == GLFW_FALSE && !content->wants_to_quit()) {
    glfwWaitEventsTimeout(kIdle_s);
    const double began_s = glfwGetTime();
    content->take_news();
    if (const auto ui_scale_set = content->ui_scale()) imgui.set_scale(*ui_scale_set);
    imgui.begin_frame(window.get());
    for (const Key& key : window.take_keys()) {
      if (ImGui::GetIO().WantTextInput)
        content->press_in_text(key);
      else
        content->press(key);
    }
    for (const std::string& file : window.take_files()) content->take_file(file);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    content->draw(size.x, size.y);
    ImGui::Render();
    int width_px = 0, height_px = 0;
    glfwGetFramebufferSize(window.get(), &width_px, &height_px);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width_px, height_px);
    const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(look::kGround);
    glClearColor(ground.x, ground.y, ground.z, ground.w);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window.get());
    const double left_s = kLeastFrame_s - (glfwGetTime() - began_s);
    if (left_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(left_s));
  }
}

}  // namespace roomradar
