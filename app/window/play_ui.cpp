// play_ui.cpp: draws the window's bar, panes and help, and executes keys.
#include "app/window/play_ui.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace roomradar {
namespace {

constexpr double kMessage_s = 5.0;
constexpr double kStall_s = 1.0;  // time without a new frame after which the bar says so

constexpr std::array<std::array<const char*, 2>, 21> kHelp = {
    {{"click on a surface", "drop the chosen object there"},
     {"Shift + click", "place it there"},
     {"drag an object", "carry it; let go in motion: throw it"},
     {"wheel while dragging", "nearer, farther"},
     {"right drag", "turn it"},
     {"D  P  T", "drop, place, throw at the mouse"},
     {"Tab", "choose the next object"},
     {"A  Del  R", "add one, remove it, reset all"},
     {"a mesh file dropped here", "add its object"},
     {"Space", "pause"},
     {".", "one more frame"},
     {"F", "hold the camera; objects keep moving"},
     {"Home", "back to the first frame"},
     {"L", "loop, or stay at the end"},
     {"+  -", "speed"},
     {"S", "next surface policy"},
     {"U", "unknown space free, solid"},
     {"X", "radar exact, sampled"},
     {"V", "camera, models, both"},
     {"C", "models: look at the chosen object"},
     {"Esc, a click", "close this; Ctrl + Q quits"}}};

}  // namespace

PlayUi::PlayUi(UiChannel& link, const look::Fonts& fonts, const std::vector<std::string>& meshes,
               std::optional<double> budget_ms)
    : link_(link), fonts_(fonts), picture_(link), timing_(budget_ms) {
  settings_.meshes = {"teapot"};
  settings_.meshes.insert(settings_.meshes.end(), meshes.begin(), meshes.end());
}

bool PlayUi::take_news() {
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

void PlayUi::count_rate() {
  ++rate_frames_;
  const double since_s = newest_s_ - rate_from_s_;
  if (since_s < 0.7) return;
  frames_per_s_ = rate_frames_ / since_s;
  rate_from_s_ = newest_s_;
  rate_frames_ = 0;
}

void PlayUi::draw(float width, float height) {
  const float scale = look::px(1.0F);
  const WindowLayout layout = window_layout(width, height, view_, scale);
  draw_bar(layout.bar);
  if (shown_.run_frame < 0) {
    draw_waiting(window_layout(width, height, MainView::kCamera, scale).camera);
  } else {
    if (!layout.camera.empty())
      picture_.draw(layout.camera, shown_, fonts_, static_cast<double>(settings_.drop_height_m));
    else
      picture_.leave();
    if (!layout.models.empty()) models_.draw(layout.models, shown_, fonts_);
  }
  timing_.draw(layout.timing, fonts_);
  radar_.draw(layout.radar, shown_.shown_radar, fonts_);
  draw_side_panel(layout.side, shown_, link_, settings_, fonts_);
  const Area main = window_layout(width, height, MainView::kCamera, scale).camera;
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
  ImGui::SameLine(0.0F, look::px(18.0F));
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
  ImGui::SameLine(0.0F, look::px(22.0F));
  const struct {
    const char* name;
    MainView view;
  } views[] = {{"Camera", MainView::kCamera}, {"Models", MainView::kModels}, {"Both", MainView::kBoth}};
  for (const auto& view : views) {
    if (look::button(view.name, view.view == MainView::kBoth ? "V" : "", view_ == view.view))
      view_ = view.view;
    ImGui::SameLine(0.0F, look::px(2.0F));
  }
  ImGui::SameLine(0.0F, look::px(22.0F));
  if (look::button("Help", "H", shows_help_)) shows_help_ = !shows_help_;
  draw_state(area);
  draw_budget(area);
  look::end_pane();
}

void PlayUi::draw_state(const Area& area) {
  ImGui::SameLine();
  ImGui::SetCursorPosX(area.width - look::px(338.0F));
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
    look::pill(look::kGood, result.tracking == TrackStatus::kDegenerate ? "partly tracked" : "tracked");
}

void PlayUi::draw_budget(const Area& area) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float frame_ms = timing_.frame_ms();
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f ms   %.0f fps", static_cast<double>(frame_ms), frames_per_s_);
  if (speed_ != 1.0)
    std::snprintf(text.data(), text.size(), "%.1f ms   %.0f fps   x%g", static_cast<double>(frame_ms),
                  frames_per_s_, speed_);
  const float left = area.width - look::px(182.0F), top = area.y + look::px(10.0F), width = look::px(168.0F);
  draw->AddText(fonts_.small, fonts_.small->FontSize, {left, top}, look::kText, text.data());
  // Frame time and goal as fractions of the budget.
  const float bar_y = top + look::px(19.0F), bar_height = look::px(6.0F), rounding = look::px(3.0F);
  const float budget_ms = static_cast<float>(timing_.budget_ms());
  const float goal_ms = static_cast<float>(timing_.goal_ms());
  const float part = std::min(frame_ms / budget_ms, 1.0F);
  const ImU32 colour = frame_ms <= goal_ms ? look::kGood : frame_ms <= budget_ms ? look::kWarn : look::kBad;
  draw->AddRectFilled({left, bar_y}, {left + width, bar_y + bar_height}, look::kRaised, rounding);
  draw->AddRectFilled({left, bar_y}, {left + std::max(part * width, bar_height), bar_y + bar_height}, colour,
                      rounding);
  const float goal_x = left + goal_ms / budget_ms * width;
  draw->AddLine({goal_x, bar_y - look::px(2.0F)}, {goal_x, bar_y + look::px(8.0F)}, look::kDim,
                look::px(1.0F));
}

void PlayUi::draw_message(const Area& area) {
  if (ImGui::GetTime() > message_until_s_ || message_.empty()) return;
  const ImVec2 size = ImGui::CalcTextSize(message_.c_str(), nullptr, false, 0.8F * area.width);
  const ImVec2 at{area.x + 0.5F * (area.width - size.x), area.y + area.height - size.y - look::px(24.0F)};
  const float beside = look::px(14.0F), above = look::px(8.0F);
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->AddRectFilled({at.x - beside, at.y - above}, {at.x + size.x + beside, at.y + size.y + above},
                      IM_COL32(38, 44, 54, 240), look::px(8.0F));
  draw->AddText(nullptr, 0.0F, at, look::kWarn, message_.c_str(), nullptr, 0.8F * area.width);
}

void PlayUi::draw_help(float width, float height) {
  const float row = look::px(23.0F), wide = look::px(520.0F);
  const float tall = row * static_cast<float>(kHelp.size()) + look::px(62.0F);
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->AddRectFilled({0.0F, 0.0F}, {width, height}, IM_COL32(8, 10, 13, 150));
  const float left = 0.5F * (width - wide), top = 0.5F * (height - tall);
  // A transparent window over all panes, so a click reaches nothing else.
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize({width, height});
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground);
  ImGui::SetCursorScreenPos({0.0F, 0.0F});
  if (ImGui::InvisibleButton("close", {width, height})) shows_help_ = false;
  ImGui::End();
  draw->AddRectFilled({left, top}, {left + wide, top + tall}, look::kRaised, look::px(10.0F));
  draw->AddText(fonts_.large, fonts_.large->FontSize, {left + look::px(24.0F), top + look::px(18.0F)},
                look::kText, "Mouse and keys");
  float y = top + look::px(50.0F);
  for (const auto& [keys, what] : kHelp) {
    draw->AddText({left + look::px(24.0F), y}, look::kAccent, keys);
    draw->AddText({left + look::px(210.0F), y}, look::kText, what);
    y += row;
  }
}

void PlayUi::ask_at_mouse(UserCommandKind kind) {
  if (!picture_.pixel()) return;
  UserCommand command;
  command.kind = kind;
  command.pixel = *picture_.pixel();
  command.event.height_m = static_cast<double>(settings_.drop_height_m);
  command.speed_mps = static_cast<double>(settings_.throw_speed_mps);
  link_.ask(command);
}

void PlayUi::add_object() { link_.ask(new_object_command(settings_)); }

void PlayUi::take_file(const std::string& path) {
  const auto known = std::find(settings_.meshes.begin(), settings_.meshes.end(), path);
  settings_.mesh = static_cast<std::size_t>(known - settings_.meshes.begin());
  if (known == settings_.meshes.end()) settings_.meshes.push_back(path);
  add_object();
}

void PlayUi::choose_next() {
  if (shown_.objects.empty()) return;
  const auto chosen = std::find_if(shown_.objects.begin(), shown_.objects.end(),
                                   [&](const ShownObject& object) { return object.name == shown_.chosen; });
  const std::size_t at = static_cast<std::size_t>(chosen - shown_.objects.begin());
  UserCommand command;
  command.kind = UserCommandKind::kChoose;
  command.event.name = shown_.chosen = shown_.objects[(at + 1) % shown_.objects.size()].name;
  link_.ask(command);
}

void PlayUi::set_speed(double speed) {
  speed_ = std::clamp(speed, 0.125, 8.0);
  link_.set_speed(speed_);
}

bool PlayUi::repeats(int key) {
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

void PlayUi::press(int key, int modifiers) {
  UserCommand command;
  switch (key) {
    case GLFW_KEY_SPACE:
      link_.set_paused(!link_.is_paused());
      break;
    case GLFW_KEY_PERIOD:
    case GLFW_KEY_KP_DECIMAL:
      if (!link_.is_paused()) link_.set_paused(true);
      link_.step();
      break;
    case GLFW_KEY_HOME:
      link_.ask(camera_command(CameraPlay::kRewind));
      if (std::exchange(shown_.is_held, false)) link_.ask(camera_command(CameraPlay::kGo));
      break;
    case GLFW_KEY_F:  // shown at once: the next key may precede the next frame
      shown_.is_held = !shown_.is_held;
      link_.ask(camera_command(shown_.is_held ? CameraPlay::kHold : CameraPlay::kGo));
      break;
    case GLFW_KEY_L:
      shown_.at_end = shown_.at_end == AtEnd::kLoop ? AtEnd::kStay : AtEnd::kLoop;
      link_.ask(camera_command(shown_.at_end == AtEnd::kLoop ? CameraPlay::kLoop : CameraPlay::kStay));
      break;
    case GLFW_KEY_D:
      ask_at_mouse(UserCommandKind::kDrop);
      break;
    case GLFW_KEY_P:
      ask_at_mouse(UserCommandKind::kPlace);
      break;
    case GLFW_KEY_T:
      ask_at_mouse(UserCommandKind::kThrow);
      break;
    case GLFW_KEY_TAB:
      choose_next();
      break;
    case GLFW_KEY_A:
      add_object();
      break;
    case GLFW_KEY_DELETE:
    case GLFW_KEY_BACKSPACE:
      command.kind = UserCommandKind::kRemove;
      link_.ask(command);
      break;
    case GLFW_KEY_R:
      command.kind = UserCommandKind::kReset;
      link_.ask(command);
      break;
    // These change shown_ at once, too, because the next key may precede the next frame.
    case GLFW_KEY_S: {
      constexpr std::array<SurfacePolicy, 4> kNext = {SurfacePolicy::kSkirt, SurfacePolicy::kBorder,
                                                      SurfacePolicy::kMap, SurfacePolicy::kHoles};
      shown_.surfaces = kNext[static_cast<std::size_t>(shown_.surfaces)];
      link_.ask(surfaces_command(shown_.surfaces));
      break;
    }
    case GLFW_KEY_U:
      shown_.unknown_is_solid = !shown_.unknown_is_solid;
      link_.ask(unknown_command(shown_.unknown_is_solid));
      break;
    case GLFW_KEY_X:
      shown_.radar.mode = shown_.radar.mode == RadarMode::kExact ? RadarMode::kSampled : RadarMode::kExact;
      link_.ask(radar_command(shown_.radar));
      break;
    case GLFW_KEY_V:
      view_ = view_ == MainView::kCamera   ? MainView::kModels
              : view_ == MainView::kModels ? MainView::kBoth
                                           : MainView::kCamera;
      break;
    case GLFW_KEY_C:
      models_.look_at_chosen(shown_);
      break;
    case '+':
    case GLFW_KEY_EQUAL:  // types + with Shift
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

}  // namespace roomradar
