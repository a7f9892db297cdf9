// play_window.cpp: shows the window with its bar, panes and keys, and runs the session on another thread.
//
// The window's OpenGL context shares nothing with the radar's. Contexts share objects only on one EGL
// display; the radar's is a device display without a window system, to be the same with and without a window,
// while the window's is X11's. Nothing is lost: the picture is composed in main memory for videos and reports
// anyway, and is uploaded as a texture of 0.9 MB in some 0.2 ms. Two contexts also let the session run on
// another thread.
#include "app/window/play_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/cli/interrupt.hpp"
#include "app/window/glfw_window.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/panes.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {
namespace {

/// Draws the window and handles its keys. All calls must come from the window's thread, within Dear ImGui's
/// frames.
class PlayUi final : public WindowContent {
 public:
  /// @param meshes     objects that can be added, in addition to the built-in teapot
  /// @param budget_ms  the run's time limit per frame; unset: none
  PlayUi(UiChannel& link, const look::Fonts& fonts, const std::vector<ObjectSource>& meshes,
         std::optional<double> budget_ms);

  void take_news() override;
  void press(const Key& key) override;
  void take_file(const std::string& path) override;
  void draw(float width, float height) override;
  [[nodiscard]] bool wants_to_quit() const override { return quits_; }

 private:
  struct Message {
    std::string text;
    double until_s = 0.0;
  };
  struct FrameRate {
    double from_s = 0.0;  ///< start of the current interval
    int frames = 0;       ///< number of frames since from_s
    double frames_per_s = 0.0;
  };

  UiChannel& link_;
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
  Message message_;
  double newest_s_ = 0.0;
  FrameRate rate_;

  void count_rate();
  void add_object();
  void choose_next();
  void press(int key, int modifiers = 0);
  // Each function handles one group of keys and returns false for other keys.
  bool press_run_key(int key);
  bool press_object_key(int key);
  bool press_scene_key(int key);
  bool press_window_key(int key, int modifiers);
  void set_speed(double speed);
  void draw_bar(const Area& area, bool has_two_rows);
  void draw_message(const Area& area);
  void draw_waiting(const Area& area);
};

constexpr double kMessage_s = 5.0;

/// Returns true if a key's action is repeated while the key is held down.
bool repeats(int key) {
  switch (key) {
    case GLFW_KEY_PERIOD:
    case GLFW_KEY_KP_DECIMAL:
    case GLFW_KEY_TAB:
    case '+':
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      return true;
    default:
      return false;
  }
}

PlayUi::PlayUi(UiChannel& link, const look::Fonts& fonts, const std::vector<ObjectSource>& meshes,
               std::optional<double> budget_ms)
    : link_(link), fonts_(fonts), picture_(link), timing_(budget_ms) {
  settings_.meshes = {{.mesh = "teapot"}};
  settings_.meshes.insert(settings_.meshes.end(), meshes.begin(), meshes.end());
}

void PlayUi::take_news() {
  if (const std::string message = link_.take_message(); !message.empty())
    message_ = {message, ImGui::GetTime() + kMessage_s};
  const std::int64_t before = shown_.run_frame;
  if (!link_.take(shown_)) return;
  picture_.upload(shown_);
  models_.upload(shown_);
  radar_.upload(shown_.shown_radar);
  if (shown_.run_frame != before) timing_.add(shown_);
  newest_s_ = ImGui::GetTime();
  count_rate();
}

void PlayUi::count_rate() {
  ++rate_.frames;
  const double since_s = newest_s_ - rate_.from_s;
  if (since_s < 0.7) return;
  rate_.frames_per_s = rate_.frames / since_s;
  rate_.from_s = newest_s_;
  rate_.frames = 0;
}

void PlayUi::draw(float width, float height) {
  const float scale = look::px(1.0F);
  const WindowLayout layout = window_layout(width, height, view_, scale);
  draw_bar(layout.bar, layout.has_two_rows);
  if (shown_.run_frame < 0) {
    draw_waiting(window_layout(width, height, MainView::kCamera, scale).camera);
  } else {
    if (!layout.camera.empty())
      picture_.draw(layout.camera, shown_, fonts_, static_cast<double>(settings_.drop_height_m));
    else
      picture_.leave();
    if (!layout.models.empty()) models_.draw(layout.models, shown_, fonts_);
  }
  if (!layout.timing.empty()) timing_.draw(layout.timing, fonts_);
  if (!layout.radar.empty()) radar_.draw(layout.radar, shown_.shown_radar, fonts_);
  draw_side_panel(layout.side, shown_, link_, settings_, fonts_);
  draw_message(window_layout(width, height, MainView::kCamera, scale).camera);
  if (shows_help_ && draw_help(width, height, fonts_)) shows_help_ = false;
  link_.want({.radar = true, .models = view_ != MainView::kCamera, .point_px = picture_.pixel()});
}

void PlayUi::draw_waiting(const Area& area) {
  look::begin_pane("waiting", area, look::kGround);
  const char* text = link_.is_over() ? "the run is over" : "loading the map, waiting for the first frame ...";
  const float wrap = 0.8F * area.width;
  const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, wrap);
  ImGui::SetCursorScreenPos({area.x + 0.5F * (area.width - size.x), area.y + 0.5F * (area.height - size.y)});
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wrap);
  ImGui::TextDisabled("%s", text);
  ImGui::PopTextWrapPos();
  look::end_pane();
}

void PlayUi::draw_bar(const Area& area, bool has_two_rows) {
  look::begin_pane("bar", area, look::kPanel);
  const float gap = look::px(has_two_rows ? 3.0F : 8.0F), wide_gap = look::px(has_two_rows ? 8.0F : 12.0F);
  if (!has_two_rows) look::title("roomradar", wide_gap, fonts_);
  const auto button = [&](const char* label, const char* key, bool is_lit) {
    const bool is_clicked = look::button(label, has_two_rows ? "" : key, is_lit);
    ImGui::SameLine(0.0F, gap);
    return is_clicked;
  };
  const bool is_paused = link_.is_paused();
  if (button(is_paused ? "Play" : "Pause", "Space", is_paused)) press(GLFW_KEY_SPACE);
  if (button("Step", ".", false)) press(GLFW_KEY_PERIOD);
  if (button("Restart", "Home", false)) press(GLFW_KEY_HOME);
  if (button("Hold", "F", shown_.is_held)) press(GLFW_KEY_F);
  if (button("Loop", "L", shown_.at_end == AtEnd::kLoop)) press(GLFW_KEY_L);
  ImGui::SameLine(0.0F, wide_gap);
  const struct {
    const char* name;
    MainView view;
  } views[] = {{"Camera", MainView::kCamera}, {"Models", MainView::kModels}, {"Both", MainView::kBoth}};
  for (const auto& view : views) {
    if (button(view.name, view.view == MainView::kBoth ? "V" : "", view_ == view.view)) view_ = view.view;
    ImGui::SameLine(0.0F, look::px(2.0F));
  }
  ImGui::SameLine(0.0F, wide_gap);
  if (button("Scan more", "M", false)) press(GLFW_KEY_M);
  if (button("Help", "H", shows_help_)) press(GLFW_KEY_H);
  if (has_two_rows) ImGui::NewLine();
  draw_run_state(area, has_two_rows, shown_, link_, ImGui::GetTime() - newest_s_);
  draw_frame_time(area, has_two_rows, timing_, rate_.frames_per_s, speed_, fonts_);
  look::end_pane();
}

void PlayUi::draw_message(const Area& area) {
  if (ImGui::GetTime() > message_.until_s || message_.text.empty()) return;
  const ImVec2 size = ImGui::CalcTextSize(message_.text.c_str(), nullptr, false, 0.8F * area.width);
  const ImVec2 at{area.x + 0.5F * (area.width - size.x), area.y + area.height - size.y - look::px(24.0F)};
  const float beside = look::px(14.0F), above = look::px(8.0F);
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->AddRectFilled({at.x - beside, at.y - above}, {at.x + size.x + beside, at.y + size.y + above},
                      IM_COL32(38, 44, 54, 240), look::px(8.0F));
  draw->AddText(nullptr, 0.0F, at, look::kWarn, message_.text.c_str(), nullptr, 0.8F * area.width);
}

void PlayUi::add_object() { link_.ask(new_object_command(settings_)); }

void PlayUi::take_file(const std::string& path) {
  const auto known = std::find_if(settings_.meshes.begin(), settings_.meshes.end(),
                                  [&](const ObjectSource& source) { return source.mesh == path; });
  settings_.mesh = static_cast<std::size_t>(known - settings_.meshes.begin());
  if (known == settings_.meshes.end()) settings_.meshes.push_back({.mesh = path});
  add_object();
}

void PlayUi::choose_next() {
  if (shown_.objects.empty()) return;
  const auto chosen = std::find_if(shown_.objects.begin(), shown_.objects.end(),
                                   [&](const ShownObject& object) { return object.name == shown_.chosen; });
  const std::size_t at = static_cast<std::size_t>(chosen - shown_.objects.begin());
  shown_.chosen = shown_.objects[(at + 1) % shown_.objects.size()].name;
  link_.ask(ChooseObject{shown_.chosen});
}

void PlayUi::set_speed(double speed) {
  speed_ = std::clamp(speed, 0.125, 8.0);
  link_.set_speed(speed_);
}

void PlayUi::press(const Key& key) {
  if (!key.is_repeat || repeats(key.key)) press(key.key, key.modifiers);
}

void PlayUi::press(int key, int modifiers) {
  if (press_run_key(key) || press_object_key(key) || press_scene_key(key)) return;
  static_cast<void>(press_window_key(key, modifiers));
}

/// Executes keys for pause, steps, the camera and the speed.
bool PlayUi::press_run_key(int key) {
  switch (key) {
    case GLFW_KEY_SPACE:
      link_.set_paused(!link_.is_paused());
      return true;
    case GLFW_KEY_PERIOD:
    case GLFW_KEY_KP_DECIMAL:
      if (!link_.is_paused()) link_.set_paused(true);
      link_.step();
      return true;
    case GLFW_KEY_HOME:
      link_.ask(camera_command(CameraPlay::kRewind));
      if (std::exchange(shown_.is_held, false)) link_.ask(camera_command(CameraPlay::kGo));
      return true;
    case GLFW_KEY_F:  // shown at once: the next key may precede the next frame
      shown_.is_held = !shown_.is_held;
      link_.ask(camera_command(shown_.is_held ? CameraPlay::kHold : CameraPlay::kGo));
      return true;
    case GLFW_KEY_L:
      shown_.at_end = shown_.at_end == AtEnd::kLoop ? AtEnd::kStay : AtEnd::kLoop;
      link_.ask(camera_command(shown_.at_end == AtEnd::kLoop ? CameraPlay::kLoop : CameraPlay::kStay));
      return true;
    case '+':
    case GLFW_KEY_EQUAL:  // types + with Shift
    case GLFW_KEY_KP_ADD:
      set_speed(2.0 * speed_);
      return true;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      set_speed(0.5 * speed_);
      return true;
    default:
      return false;
  }
}

/// Executes keys for objects.
bool PlayUi::press_object_key(int key) {
  const std::optional<Eigen::Vector2d>& pixel = picture_.pixel();
  switch (key) {
    case GLFW_KEY_D:
      if (pixel) link_.ask(DropChosen{*pixel, static_cast<double>(settings_.drop_height_m)});
      return true;
    case GLFW_KEY_P:
      if (pixel) link_.ask(PlaceChosen{*pixel});
      return true;
    case GLFW_KEY_T:
      if (pixel) link_.ask(ThrowChosen{*pixel, static_cast<double>(settings_.throw_speed_mps)});
      return true;
    case GLFW_KEY_TAB:
      choose_next();
      return true;
    case GLFW_KEY_A:
      add_object();
      return true;
    case GLFW_KEY_DELETE:
    case GLFW_KEY_BACKSPACE:
      link_.ask(RemoveChosen{});
      return true;
    case GLFW_KEY_R:
      link_.ask(ResetObjects{});
      return true;
    default:
      return false;
  }
}

/// Executes keys for surfaces, unknown space and radar. They change shown_ at once, because the next key may
/// precede the next frame.
bool PlayUi::press_scene_key(int key) {
  switch (key) {
    case GLFW_KEY_S: {
      constexpr std::array<SurfacePolicy, 4> kNext = {SurfacePolicy::kSkirt, SurfacePolicy::kBorder,
                                                      SurfacePolicy::kMap, SurfacePolicy::kHoles};
      shown_.surfaces = kNext[static_cast<std::size_t>(shown_.surfaces)];
      link_.ask(surfaces_command(shown_.surfaces));
      return true;
    }
    case GLFW_KEY_U:
      shown_.unknown_is_solid = !shown_.unknown_is_solid;
      link_.ask(unknown_command(shown_.unknown_is_solid));
      return true;
    case GLFW_KEY_X:
      shown_.radar.mode =
          kRadarModes[(static_cast<std::size_t>(
                           std::find(kRadarModes.begin(), kRadarModes.end(), shown_.radar.mode) -
                           kRadarModes.begin()) +
                       1) %
                      kRadarModes.size()];
      link_.ask(radar_command(shown_.radar));
      return true;
    default:
      return false;
  }
}

/// Executes keys for views, help and quitting.
bool PlayUi::press_window_key(int key, int modifiers) {
  switch (key) {
    case GLFW_KEY_V:
      view_ = static_cast<MainView>((static_cast<int>(view_) + 1) % kMainViews);
      return true;
    case GLFW_KEY_C:
      if ((modifiers & GLFW_MOD_CONTROL) == 0)
        models_.look_at_chosen(shown_);
      else if (shown_.pointed_world)
        ImGui::SetClipboardText(position_words(*shown_.pointed_world).c_str());
      return true;
    case GLFW_KEY_H:
    case GLFW_KEY_F1:
      shows_help_ = !shows_help_;
      return true;
    case GLFW_KEY_ESCAPE:
      shows_help_ = false;
      return true;
    case GLFW_KEY_M:
      link_.ask_to_scan();
      quits_ = true;
      return true;
    case GLFW_KEY_Q:
      quits_ = quits_ || (modifiers & GLFW_MOD_CONTROL) != 0;
      return true;
    default:
      return false;
  }
}

}  // namespace

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
