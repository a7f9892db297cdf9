// play_window.cpp: GLFW and Dear ImGui: the window, its keys, and the thread of the session.
//
// The window's OpenGL context is its own and shares nothing with the radar's. Contexts share objects only on
// one EGL display; the radar's is that of a device, without a window system, so that it is the same with a
// window and without, and the window's is X11's. Nothing is lost: the picture is composed in the processor's
// memory for videos and reports alike, and goes to the window as a texture of 0.9 MB, some 0.2 ms. And with
// two contexts the session can work on a thread of its own.
#include "app/window/play_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "app/window/look.hpp"
#include "app/window/model_view.hpp"
#include "app/window/picture_pane.hpp"
#include "app/window/radar_pane.hpp"
#include "app/window/side_panel.hpp"
#include "app/window/timing_pane.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr int kWidth_px = 1280, kHeight_px = 800;
constexpr double kMessage_s = 5.0;
constexpr double kStall_s = 1.0;  // without a new frame for so long, it is said

std::string last_glfw_error() {
  const char* what = nullptr;
  glfwGetError(&what);
  return what != nullptr ? what : "no reason was given";
}

struct Key {
  int key = 0;
  int modifiers = 0;  ///< as they were when it was pressed
};

/// GLFW's window with a current context. Keys that are pressed in it are kept until they are taken.
class GlfwWindow {
 public:
  explicit GlfwWindow(const std::string& title) {
    if (glfwInit() != GLFW_TRUE) {
      const std::string fault = last_glfw_error();
      const char* display = std::getenv("DISPLAY");
      throw Error("--window: there is no display to open it on (" + fault +
                  (display == nullptr ? "; DISPLAY is not set" : std::string("; DISPLAY is ") + display) +
                  "). Over ssh connect with ssh -X, or leave --window out and write what it would show with "
                  "--video FILE.mp4");
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    // By EGL where that works, as the radar: one driver in the process; else by the window system's own way.
    for (const int way : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
      glfwWindowHint(GLFW_CONTEXT_CREATION_API, way);
      window_ = glfwCreateWindow(kWidth_px, kHeight_px, title.c_str(), nullptr, nullptr);
      if (window_ != nullptr) break;
    }
    if (window_ == nullptr) {
      const std::string fault = last_glfw_error();
      glfwTerminate();
      throw Error("--window: the display gives no window with OpenGL 3.3 (" + fault +
                  "); leave --window out and write what it would show with --video FILE.mp4");
    }
    glfwSetWindowSizeLimits(window_, 900, 600, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
      if (action != GLFW_RELEASE)
        static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window))->keys_.push_back({key, modifiers});
    });
  }
  ~GlfwWindow() {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  [[nodiscard]] GLFWwindow* get() const { return window_; }
  std::vector<Key> take_keys() { return std::exchange(keys_, {}); }

 private:
  GLFWwindow* window_ = nullptr;
  std::vector<Key> keys_;
};

struct ImGuiOfWindow {
  look::Fonts fonts;

  explicit ImGuiOfWindow(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    fonts = look::apply(std::clamp(scale, 1.0F, 3.0F));
    ImGui_ImplGlfw_InitForOpenGL(window, /*install_callbacks=*/true);  // and calls those that were there
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~ImGuiOfWindow() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  ImGuiOfWindow(const ImGuiOfWindow&) = delete;
  ImGuiOfWindow& operator=(const ImGuiOfWindow&) = delete;
};

constexpr std::array<std::array<const char*, 2>, 20> kHelp = {
    {{"click on a surface", "drop the chosen object there"},
     {"Shift + click", "place it there"},
     {"drag an object", "carry it; let go in motion: throw it"},
     {"wheel while dragging", "nearer, farther"},
     {"right drag", "turn it"},
     {"D  P  T", "drop, place, throw at the mouse"},
     {"Tab", "choose the next object"},
     {"A  Del  R", "add one, remove it, reset all"},
     {"Space", "pause"},
     {".", "one frame more"},
     {"F", "hold the camera; objects go on"},
     {"Home", "back to the first frame"},
     {"L", "loop, or stay at the end"},
     {"+  -", "speed"},
     {"S", "next surface policy"},
     {"U", "unknown space free, solid"},
     {"X", "radar exact, sampled"},
     {"V", "camera, models, both"},
     {"C", "models: look at the chosen object"},
     {"Esc", "close this; Ctrl + Q quits"}}};

/// All that is seen.
class PlayUi {
 public:
  PlayUi(PlayLink& link, const look::Fonts& fonts, const std::vector<std::string>& meshes)
      : link_(link), fonts_(fonts), picture_(link) {
    settings_.meshes = {"teapot"};
    settings_.meshes.insert(settings_.meshes.end(), meshes.begin(), meshes.end());
  }

  /// Takes what is new; whether there was anything.
  bool take_news() {
    const std::string message = link_.take_message();
    if (!message.empty()) {
      message_ = message;
      message_until_s_ = ImGui::GetTime() + kMessage_s;
    }
    const std::int64_t before = shown_.run_frame;
    if (!link_.take(shown_)) return !message.empty();
    picture_.upload(shown_);
    models_.upload(shown_);
    radar_.upload(shown_.shown_radar);
    if (shown_.run_frame != before) timing_.add(shown_);
    newest_s_ = ImGui::GetTime();
    count_rate();
    return true;
  }

  void draw(float width, float height);
  void press(int key, int modifiers = 0);
  [[nodiscard]] bool wants_to_quit() const { return quits_; }

 private:
  PlayLink& link_;
  const look::Fonts& fonts_;
  Snapshot shown_;
  PicturePane picture_;
  ModelView models_;
  RadarPane radar_;
  TimingPane timing_;
  PlaySettings settings_;
  MainView view_ = MainView::kCamera;
  bool shows_help_ = false, quits_ = false;
  double speed_ = 1.0;
  std::string message_;
  double message_until_s_ = 0.0, newest_s_ = 0.0;
  double rate_from_s_ = 0.0;
  int rate_frames_ = 0;
  double frames_per_s_ = 0.0;

  void count_rate() {
    ++rate_frames_;
    const double since_s = newest_s_ - rate_from_s_;
    if (since_s < 0.7) return;
    frames_per_s_ = rate_frames_ / since_s;
    rate_from_s_ = newest_s_;
    rate_frames_ = 0;
  }
  void ask_at_mouse(WishKind kind);
  void choose_next();
  void set_speed(double speed);
  void draw_bar(const Area& area);
  void draw_state(const Area& area);
  void draw_budget(const Area& area);
  void draw_message(const Area& area);
  void draw_help(float width, float height);
  void draw_waiting(const Area& area);
};

void PlayUi::draw(float width, float height) {
  const WindowLayout layout = window_layout(width, height, view_);
  draw_bar(layout.bar);
  if (shown_.run_frame < 0) {
    draw_waiting(window_layout(width, height, MainView::kCamera).camera);
  } else {
    if (!layout.camera.empty())
      picture_.draw(layout.camera, shown_, fonts_, static_cast<double>(settings_.drop_height_m));
    if (!layout.models.empty()) models_.draw(layout.models, shown_, fonts_);
  }
  timing_.draw(layout.timing, fonts_);
  radar_.draw(layout.radar, shown_.shown_radar, fonts_);
  draw_side_panel(layout.side, shown_, link_, settings_, fonts_);
  const Area main = window_layout(width, height, MainView::kCamera).camera;
  draw_message(main);
  if (shows_help_) draw_help(width, height);
  link_.want({.radar = true, .models = view_ != MainView::kCamera});
}

void PlayUi::draw_waiting(const Area& area) {
  look::begin_pane("waiting", area, look::kGround);
  const char* text = link_.is_over() ? "the run is over" : "loading the map, waiting for the first frame ...";
  const ImVec2 size = ImGui::CalcTextSize(text);
  ImGui::SetCursorScreenPos({area.x + 0.5F * (area.width - size.x), area.y + 0.5F * (area.height - size.y)});
  ImGui::TextDisabled("%s", text);
  look::end_pane();
}

void PlayUi::draw_bar(const Area& area) {
  look::begin_pane("bar", area, look::kPanel);
  ImGui::PushFont(fonts_.large);
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, look::kAccent);
  ImGui::TextUnformatted("roomradar");
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::SameLine(0.0F, 18.0F);
  const bool is_paused = link_.is_paused();
  if (look::button(is_paused ? "Play" : "Pause", "Space", is_paused)) press(GLFW_KEY_SPACE);
  ImGui::SameLine();
  if (look::button("Step", ".", false)) press(GLFW_KEY_PERIOD);
  ImGui::SameLine();
  if (look::button("Restart", "Home", false)) press(GLFW_KEY_HOME);
  ImGui::SameLine();
  if (look::button("Hold camera", "F", shown_.is_held)) press(GLFW_KEY_F);
  ImGui::SameLine();
  if (look::button("Loop", "L", shown_.at_end == AtEnd::kLoop)) press(GLFW_KEY_L);
  ImGui::SameLine(0.0F, 22.0F);
  const struct {
    const char* name;
    MainView view;
  } views[] = {{"Camera", MainView::kCamera}, {"Models", MainView::kModels}, {"Both", MainView::kBoth}};
  for (const auto& view : views) {
    if (look::button(view.name, view.view == MainView::kBoth ? "V" : "", view_ == view.view))
      view_ = view.view;
    ImGui::SameLine(0.0F, 2.0F);
  }
  ImGui::SameLine(0.0F, 22.0F);
  if (look::button("Help", "H", shows_help_)) shows_help_ = !shows_help_;
  draw_state(area);
  draw_budget(area);
  look::end_pane();
}

void PlayUi::draw_state(const Area& area) {
  ImGui::SameLine();
  ImGui::SetCursorPosX(area.width - 338.0F);
  ImGui::AlignTextToFramePadding();
  const double silent_s = ImGui::GetTime() - newest_s_;
  const FrameResult& result = shown_.result;
  if (link_.is_over())
    look::pill(look::kDim, "the run is over");
  else if (shown_.run_frame < 0)
    look::pill(look::kDim, "loading");
  else if (link_.is_paused())
    look::pill(look::kWarn, "paused");
  else if (silent_s > kStall_s)
    look::pill(look::kBad, "no frame for " + std::to_string(static_cast<int>(silent_s)) + " s");
  else if (result.status != FrameStatus::kDone)
    look::pill(look::kBad, "not located");
  else if (shown_.is_repeating)
    look::pill(look::kGood, shown_.is_held ? "camera held" : "at the end");
  else
    look::pill(look::kGood, result.tracking == TrackStatus::kDegenerate ? "pose in part" : "tracked");
}

void PlayUi::draw_budget(const Area& area) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float frame_ms = timing_.frame_ms();
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f ms   %.0f fps", static_cast<double>(frame_ms), frames_per_s_);
  if (speed_ != 1.0)
    std::snprintf(text.data(), text.size(), "%.1f ms   %.0f fps   x%g", static_cast<double>(frame_ms),
                  frames_per_s_, speed_);
  const float left = area.width - 182.0F, top = area.y + 10.0F, width = 168.0F;
  draw->AddText(fonts_.small, fonts_.small->FontSize, {left, top}, look::kText, text.data());
  // How much of the budget the frame takes.
  const float bar_y = top + 19.0F;
  const float part = std::min(frame_ms / static_cast<float>(kBudget_ms), 1.0F);
  const ImU32 colour = frame_ms <= static_cast<float>(kGoal_ms)     ? look::kGood
                       : frame_ms <= static_cast<float>(kBudget_ms) ? look::kWarn
                                                                    : look::kBad;
  draw->AddRectFilled({left, bar_y}, {left + width, bar_y + 6.0F}, look::kRaised, 3.0F);
  draw->AddRectFilled({left, bar_y}, {left + std::max(part * width, 6.0F), bar_y + 6.0F}, colour, 3.0F);
  draw->AddLine({left + 0.5F * width, bar_y - 2.0F}, {left + 0.5F * width, bar_y + 8.0F}, look::kDim, 1.0F);
}

void PlayUi::draw_message(const Area& area) {
  if (ImGui::GetTime() > message_until_s_ || message_.empty()) return;
  const ImVec2 size = ImGui::CalcTextSize(message_.c_str(), nullptr, false, 0.8F * area.width);
  const ImVec2 at{area.x + 0.5F * (area.width - size.x), area.y + area.height - size.y - 24.0F};
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->AddRectFilled({at.x - 14.0F, at.y - 8.0F}, {at.x + size.x + 14.0F, at.y + size.y + 8.0F},
                      IM_COL32(38, 44, 54, 240), 8.0F);
  draw->AddText(nullptr, 0.0F, at, look::kWarn, message_.c_str(), nullptr, 0.8F * area.width);
}

void PlayUi::draw_help(float width, float height) {
  constexpr float kRow = 23.0F, kWidth = 520.0F;
  const float tall = kRow * static_cast<float>(kHelp.size()) + 62.0F;
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->AddRectFilled({0.0F, 0.0F}, {width, height}, IM_COL32(8, 10, 13, 150));
  const float left = 0.5F * (width - kWidth), top = 0.5F * (height - tall);
  draw->AddRectFilled({left, top}, {left + kWidth, top + tall}, look::kRaised, 10.0F);
  draw->AddText(fonts_.large, fonts_.large->FontSize, {left + 24.0F, top + 18.0F}, look::kText,
                "Mouse and keys");
  float y = top + 50.0F;
  for (const auto& [keys, what] : kHelp) {
    draw->AddText({left + 24.0F, y}, look::kAccent, keys);
    draw->AddText({left + 210.0F, y}, look::kText, what);
    y += kRow;
  }
}

void PlayUi::ask_at_mouse(WishKind kind) {
  if (!picture_.pixel()) return;
  Wish wish;
  wish.kind = kind;
  wish.pixel = *picture_.pixel();
  wish.event.height_m = static_cast<double>(settings_.drop_height_m);
  wish.speed_mps = static_cast<double>(settings_.throw_speed_mps);
  link_.ask(wish);
}

void PlayUi::choose_next() {
  if (shown_.objects.empty()) return;
  const auto chosen = std::find_if(shown_.objects.begin(), shown_.objects.end(),
                                   [&](const ShownObject& object) { return object.name == shown_.chosen; });
  const std::size_t at = static_cast<std::size_t>(chosen - shown_.objects.begin());
  Wish wish;
  wish.kind = WishKind::kChoose;
  wish.event.name = shown_.objects[(at + 1) % shown_.objects.size()].name;
  link_.ask(wish);
}

void PlayUi::set_speed(double speed) {
  speed_ = std::clamp(speed, 0.125, 8.0);
  link_.set_speed(speed_);
}

void PlayUi::press(int key, int modifiers) {
  Wish wish;
  switch (key) {
    case GLFW_KEY_SPACE:
      link_.set_paused(!link_.is_paused());
      break;
    case GLFW_KEY_PERIOD:
      if (!link_.is_paused()) link_.set_paused(true);
      link_.step();
      break;
    case GLFW_KEY_HOME:
      link_.ask(camera_wish(CameraPlay::kRewind));
      if (shown_.is_held) link_.ask(camera_wish(CameraPlay::kGo));
      break;
    case GLFW_KEY_F:
      link_.ask(camera_wish(shown_.is_held ? CameraPlay::kGo : CameraPlay::kHold));
      break;
    case GLFW_KEY_L:
      link_.ask(camera_wish(shown_.at_end == AtEnd::kLoop ? CameraPlay::kStay : CameraPlay::kLoop));
      break;
    case GLFW_KEY_D:
      ask_at_mouse(WishKind::kDrop);
      break;
    case GLFW_KEY_P:
      ask_at_mouse(WishKind::kPlace);
      break;
    case GLFW_KEY_T:
      ask_at_mouse(WishKind::kThrow);
      break;
    case GLFW_KEY_TAB:
      choose_next();
      break;
    case GLFW_KEY_A:
      wish.kind = WishKind::kNew;
      wish.event.mesh = settings_.meshes[settings_.mesh];
      if (settings_.new_size_m >= 0.001F) wish.event.size_m = static_cast<double>(settings_.new_size_m);
      link_.ask(wish);
      break;
    case GLFW_KEY_DELETE:
    case GLFW_KEY_BACKSPACE:
      wish.kind = WishKind::kRemove;
      link_.ask(wish);
      break;
    case GLFW_KEY_R:
      wish.kind = WishKind::kReset;
      link_.ask(wish);
      break;
    // What is asked for is shown at once: the next key may come before the next frame does.
    case GLFW_KEY_S: {
      constexpr std::array<SurfacePolicy, 4> kNext = {SurfacePolicy::kSkirt, SurfacePolicy::kBorder,
                                                      SurfacePolicy::kMap, SurfacePolicy::kHoles};
      shown_.surfaces = kNext[static_cast<std::size_t>(shown_.surfaces)];
      link_.ask(surfaces_wish(shown_.surfaces));
      break;
    }
    case GLFW_KEY_U:
      shown_.unknown_is_solid = !shown_.unknown_is_solid;
      link_.ask(unknown_wish(shown_.unknown_is_solid));
      break;
    case GLFW_KEY_X:
      shown_.radar.mode = shown_.radar.mode == RadarMode::kExact ? RadarMode::kSampled : RadarMode::kExact;
      link_.ask(radar_wish(shown_.radar));
      break;
    case GLFW_KEY_V:
      view_ = view_ == MainView::kCamera   ? MainView::kModels
              : view_ == MainView::kModels ? MainView::kBoth
                                           : MainView::kCamera;
      break;
    case GLFW_KEY_C:
      models_.look_at_chosen(shown_);
      break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      set_speed(2.0 * speed_);
      break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      set_speed(0.5 * speed_);
      break;
    case GLFW_KEY_H:
    case GLFW_KEY_F1:
      shows_help_ = !shows_help_;
      break;
    case GLFW_KEY_ESCAPE:
      shows_help_ = false;
      break;
    case GLFW_KEY_Q:
      quits_ = quits_ || (modifiers & GLFW_MOD_CONTROL) != 0;
      break;
    default:
      break;
  }
}

/// Draws when something has happened, and some frames more, since Dear ImGui answers a frame late; else
/// seldom.
void show(GlfwWindow& window, PlayLink& link, const std::vector<std::string>& meshes) {
  const ImGuiOfWindow imgui(window.get());
  PlayUi ui(link, imgui.fonts, meshes);
  constexpr double kLeastFrame_s = 1.0 / 60.0, kIdle_s = 0.25;
  while (glfwWindowShouldClose(window.get()) == GLFW_FALSE && !ui.wants_to_quit()) {
    glfwWaitEventsTimeout(kIdle_s);
    const double began_s = glfwGetTime();
    ui.take_news();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    const std::vector<Key> keys = window.take_keys();
    if (!ImGui::GetIO().WantTextInput)
      for (const Key& key : keys) ui.press(key.key, key.modifiers);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ui.draw(size.x, size.y);
    ImGui::Render();
    int width_px = 0, height_px = 0;
    glfwGetFramebufferSize(window.get(), &width_px, &height_px);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width_px, height_px);
    glClearColor(0.063F, 0.075F, 0.094F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window.get());
    const double left_s = kLeastFrame_s - (glfwGetTime() - began_s);
    if (left_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(left_s));
  }
}

}  // namespace

int run_in_window(const std::string& title, const std::vector<std::string>& meshes,
                  const std::function<int(PlayLink&)>& work) {
  GlfwWindow window(title);
  PlayLink link([] { glfwPostEmptyEvent(); });
  int status = 0;
  std::exception_ptr fault;
  std::thread session([&] {
    try {
      status = work(link);
    } catch (...) {
      fault = std::current_exception();
      glfwSetWindowShouldClose(window.get(), GLFW_TRUE);  // may be called from any thread
    }
    link.finish();
  });
  try {
    show(window, link, meshes);
  } catch (...) {
    link.close();
    session.join();
    throw;
  }
  link.close();
  session.join();
  if (fault) std::rethrow_exception(fault);
  return status;
}

}  // namespace roomradar
