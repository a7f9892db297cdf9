// start_window.cpp: shows the start view, and executes its actions.
#include "app/window/start/start_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>

#include "app/start/background_jobs.hpp"
#include "app/start/doctor.hpp"
#include "app/start/map_tasks.hpp"
#include "app/start/start_state.hpp"
#include "app/window/glfw_window.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/start/examined_maps.hpp"
#include "app/window/start/start_layout.hpp"
#include "app/window/start/start_panes.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Draws the start view and handles its keys. All calls must come from the window's thread.
class StartUi final : public WindowContent {
 public:
  /// @param state   the lists and the chosen entries
  /// @param choice  receives the user's decision
  /// @param wake    makes the window draw again; called on any thread
  StartUi(StartState& state, StartChoice& choice, const look::Fonts& fonts, std::function<void()> wake);

  void take_news() override;
  void press(const Key& key) override;
  void press_in_text(const Key& key) override;
  void take_file(const std::string& path) override;
  void draw(float width, float height) override;
  [[nodiscard]] bool wants_to_quit() const override { return quits_; }
  [[nodiscard]] std::optional<double> ui_scale() const override { return state_.settings.ui_scale; }

 private:
  StartState& state_;
  StartChoice& choice_;
  const look::Fonts& fonts_;
  std::vector<SourceEntry> recordings_;
  ExaminedMaps examined_;
  StartDialog dialog_;
  std::string work_;             ///< name of the action that runs in the background; empty: none
  double listed_s_ = -1.0;       ///< time at which the lists were last refreshed; < 0: not so far
  bool has_recordings_ = false;  ///< false: recordings_ are not known so far
  bool scrolls_to_choice_ = true, quits_ = false;
  BackgroundJobs jobs_;  ///< declared last because its results refer to the members above

  void list_recordings_again();
  void press_key(int key, int modifiers);
  void begin(StartAction action);
  void open(DialogKind kind, const std::string& heading, std::vector<DialogLine> lines);
  void say(std::string sentence, bool is_fault);
  void answer(DialogAnswer answer);
  void scan();
  void rename();
  void remove();
  void export_map_to(const std::string& extension);
  void compare();
  void examine_setup();
  template <typename Work, typename Done>
  void run_job(const std::string& name, Work work, Done done);
  void change_scale(int steps);
  void draw_bar(const Area& area);
};

constexpr double kListEvery_s = 2.0;

bool leaves(StartAction action) {
  return action == StartAction::kPlay || action == StartAction::kScanMore || action == StartAction::kQuit;
}

void set_name(StartDialog& dialog, const std::string& name) {
  format_classic(dialog.name.data(), dialog.name.size(), "%s", name.c_str());
}

StartUi::StartUi(StartState& state, StartChoice& choice, const look::Fonts& fonts, std::function<void()> wake)
    : state_(state), choice_(choice), fonts_(fonts), jobs_(std::move(wake)) {
  refresh_sources(state_, recordings_);
  refresh_maps(state_);
  list_recordings_again();
  if (state_.message.is_fault) say(state_.message.text, true);
}

void StartUi::list_recordings_again() {
  jobs_.add([folder = state_.folder] { return list_recordings(folder); },
            [this](std::vector<SourceEntry> recordings) {
              recordings_ = std::move(recordings);
              const bool is_untouched = !has_recordings_ && state_.source == 0;
              has_recordings_ = true;
              if (is_untouched) state_.sources.clear();  // then the first of the new list is chosen
              refresh_sources(state_, recordings_);
              scrolls_to_choice_ = true;
            },
            [](const std::string&) {});
}

void StartUi::take_news() {
  jobs_.deliver();
  const double now_s = ImGui::GetTime();
  if (now_s - listed_s_ >= kListEvery_s) {  // a Kinect may have been plugged in, a map made elsewhere
    refresh_sources(state_, recordings_);
    refresh_maps(state_);
    listed_s_ = now_s;
  }
  if (jobs_.is_idle()) examined_.examine_next(state_, jobs_);
}

void StartUi::take_file(const std::string& path) {
  state_.message = {};
  choose(state_, path);
  scrolls_to_choice_ = true;
  if (state_.message.is_fault) say(state_.message.text, true);
}

void StartUi::press(const Key& key) {
  const bool moves = key.key == GLFW_KEY_UP || key.key == GLFW_KEY_DOWN;
  if (!key.is_repeat || moves) press_key(key.key, key.modifiers);
}

void StartUi::press_in_text(const Key& key) {
  if (!key.is_repeat && dialog_.kind != DialogKind::kNone) dialog_.pressed = answer_of_key(key.key, dialog_);
}

void StartUi::press_key(int key, int modifiers) {
  if (key == GLFW_KEY_Q && (modifiers & GLFW_MOD_CONTROL) != 0) quits_ = true;
  if (dialog_.kind != DialogKind::kNone) return answer(answer_of_key(key, dialog_));
  const bool is_enter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
  constexpr int kPage = 5, kAll = 1 << 20;
  const std::array<std::array<int, 2>, 6> moves = {{{GLFW_KEY_UP, -1},
                                                    {GLFW_KEY_DOWN, 1},
                                                    {GLFW_KEY_PAGE_UP, -kPage},
                                                    {GLFW_KEY_PAGE_DOWN, kPage},
                                                    {GLFW_KEY_HOME, -kAll},
                                                    {GLFW_KEY_END, kAll}}};
  for (const auto& [move, rows] : moves) {
    if (key != move) continue;
    move_choice(state_, rows);
    scrolls_to_choice_ = true;
  }
  if (key == GLFW_KEY_TAB || key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT)
    state_.active = state_.active == StartList::kMaps ? StartList::kSources : StartList::kMaps;
  if (is_enter) begin(first_action(state_));
  if (const auto action = action_of_key(key)) begin(*action);
  if (key == GLFW_KEY_F5) list_recordings_again();
  if (key == '+' || key == '=' || key == GLFW_KEY_KP_ADD) change_scale(1);
  if (key == '-' || key == GLFW_KEY_KP_SUBTRACT) change_scale(-1);
}

/// Opens the dialog for an action's input, or ends the view with the action.
void StartUi::begin(StartAction action) {
  state_.message = {};
  if (const std::string reason = why_not(state_, action); !reason.empty()) return say(reason, true);
  const SourceEntry* source = chosen_source(state_);
  const MapEntry* map = chosen_map(state_);
  const std::string name = map != nullptr ? map->folder.lexically_normal().string() : "";
  if (leaves(action)) {
    choice_ = {action, action == StartAction::kPlay ? source->play_source : source->source, name};
    quits_ = true;
    return;
  }
  if (!work_.empty()) return say("Still at work: " + work_ + ". Wait until it is done.", false);
  switch (action) {
    case StartAction::kScan:
      open(DialogKind::kNewMap, "Scan " + source->source, {{"Name of the new map:"}});
      return set_name(dialog_, proposed_map_name(state_.folder, std::time(nullptr)));
    case StartAction::kRename:
      open(DialogKind::kRename, "Rename " + name, {{"New name:"}});
      return set_name(dialog_, map->folder.filename().string());
    case StartAction::kDelete:
      return open(
          DialogKind::kDelete, "Delete " + name + "?",
          {{"The map" + std::string(map->has_unfinished_scan ? " and its interrupted scan are" : " is") +
            " deleted from the disk. This cannot be undone."}});
    case StartAction::kExport:
      return open(DialogKind::kExport, "Export " + name,
                  {{"The room's surface is written beside the map, for 3D programs."}});
    case StartAction::kCompare:
      open(DialogKind::kCompare, "Compare " + name + " with", {});
      for (const MapEntry& each : state_.maps)
        if (&each != map) dialog_.choices.push_back(each.folder.lexically_normal().string());
      return;
    case StartAction::kDoctor:
      return examine_setup();
    default:
      return;
  }
}

void StartUi::open(DialogKind kind, const std::string& heading, std::vector<DialogLine> lines) {
  dialog_ = {};
  dialog_.kind = kind;
  dialog_.heading = heading;
  dialog_.lines = std::move(lines);
}

/// Shows a sentence: a fault over the window, else in the bar.
void StartUi::say(std::string sentence, bool is_fault) {
  state_.message = {};
  if (is_fault)
    open(DialogKind::kNotice, "What is wrong", {{std::move(sentence), look::kWarn}});
  else
    state_.message = {std::move(sentence), false};
}

void StartUi::answer(DialogAnswer answer) {
  if (answer == DialogAnswer::kNone) return;
  const DialogKind kind = dialog_.kind;
  if (answer == DialogAnswer::kNo) {
    dialog_ = {};
    return;
  }
  try {
    if (kind == DialogKind::kNewMap) scan();
    if (kind == DialogKind::kRename) rename();
    if (kind == DialogKind::kDelete) remove();
    if (kind == DialogKind::kExport)
      export_map_to(answer == DialogAnswer::kPage ? ".html" : answer == DialogAnswer::kPly ? ".ply" : ".glb");
    if (kind == DialogKind::kCompare) compare();
  } catch (const std::exception& error) {
    if (kind != DialogKind::kNewMap && kind != DialogKind::kRename) return say(error.what(), true);
    dialog_.fault = error.what();
    dialog_.is_new = true;  // the name can be edited at once
  }
}

void StartUi::scan() {
  const std::string map = dialog_.name.data();
  require_can_become_map(map, {});
  if (is_map(tidy_map_name(map)))
    throw Error(map + ": already exists; choose another name, or Back and Scan more (M)");
  const SourceEntry* source = chosen_source(state_);
  if (source == nullptr) throw Error("the source is gone; go back and choose another");
  choice_ = {StartAction::kScan, source->source, map};
  quits_ = true;
}

void StartUi::rename() {
  const MapEntry* map = chosen_map(state_);
  if (map == nullptr) throw Error("the map is gone");
  const std::filesystem::path renamed = rename_map(map->folder, dialog_.name.data());
  if (state_.settings.last_map == map->folder.lexically_normal().string())
    state_.settings.last_map = renamed.lexically_normal().string();
  dialog_ = {};
  state_.maps[state_.map].folder = renamed;  // stays chosen
  refresh_maps(state_);
  say("The map is now " + renamed.lexically_normal().string() + ".", false);
}

void StartUi::remove() {
  const MapEntry* map = chosen_map(state_);
  if (map == nullptr) throw Error("the map is gone");
  const std::string name = map->folder.lexically_normal().string();
  delete_map(map->folder);
  dialog_ = {};
  const std::size_t row = state_.map;
  refresh_maps(state_);
  state_.map = std::min(row, state_.maps.empty() ? 0 : state_.maps.size() - 1);
  say(name + " is deleted.", false);
}

/// Runs `work` in the background, and `done` with its result on this thread. Errors become a notice.
template <typename Work, typename Done>
void StartUi::run_job(const std::string& name, Work work, Done done) {
  dialog_ = {};
  work_ = name;
  jobs_.add(
      std::move(work),
      [this, done = std::move(done)](auto result) {
        work_.clear();
        done(std::move(result));
      },
      [this](const std::string& fault) {
        work_.clear();
        say(fault, true);
      });
}

void StartUi::export_map_to(const std::string& extension) {
  const MapEntry* map = chosen_map(state_);
  if (map == nullptr) throw Error("the map is gone");
  run_job(
      "exporting", [folder = map->folder, extension] { return export_beside(folder, extension); },
      [this](const std::filesystem::path& path) {
        say(path.lexically_normal().string() + " is written.", false);
      });
}

void StartUi::compare() {
  const MapEntry* map = chosen_map(state_);
  const auto row = static_cast<std::size_t>(dialog_.choice);
  if (map == nullptr || row >= dialog_.choices.size()) throw Error("the map is gone");
  const std::filesystem::path other = dialog_.choices[row];
  const MapEntry second = describe_map(other);
  if (!second.fault.empty()) throw Error(second.fault);
  const bool is_second_earlier = second.saved_at < map->saved_at;
  const std::filesystem::path earlier = is_second_earlier ? other : map->folder,
                              later = is_second_earlier ? map->folder : other;
  run_job(
      "comparing", [earlier, later] { return compare_maps(earlier, later); },
      [this, earlier, later](const std::vector<std::string>& sentences) {
        std::vector<DialogLine> lines = {
            {"From " + earlier.lexically_normal().string() + " to " + later.lexically_normal().string() + ":",
             look::kDim}};
        for (const std::string& sentence : sentences) lines.push_back({sentence});
        open(DialogKind::kNotice, "What has changed", std::move(lines));
      });
}

void StartUi::examine_setup() {
  run_job("checking the set-up", check_setup, [this](const std::vector<Finding>& findings) {
    std::vector<DialogLine> lines;
    for (const Finding& finding : findings) {
      lines.push_back({finding.what, finding.health == Health::kGood  ? look::kGood
                                     : finding.health == Health::kBad ? look::kBad
                                                                      : look::kWarn});
      if (!finding.what_to_do.empty()) lines.push_back({finding.what_to_do});
    }
    open(DialogKind::kNotice, "What of the set-up works", std::move(lines));
  });
}

void StartUi::change_scale(int steps) {
  constexpr std::array<double, 9> kScales = {0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0};
  const double now = static_cast<double>(look::px(1.0F));  // may be less than requested
  const auto above = std::upper_bound(kScales.begin(), kScales.end(), now + 1e-3);
  const auto from = std::lower_bound(kScales.begin(), kScales.end(), now - 1e-3);
  if (steps > 0 && above != kScales.end()) state_.settings.ui_scale = *above;
  if (steps < 0 && from != kScales.begin()) state_.settings.ui_scale = *(from - 1);
}

void StartUi::draw(float width, float height) {
  const StartLayout layout = start_layout(width, height, look::px(1.0F));
  draw_bar(layout.bar);
  draw_sources(layout.sources, state_, fonts_, scrolls_to_choice_);
  draw_maps(layout.maps, state_, examined_, fonts_, scrolls_to_choice_);
  draw_detail(layout.detail, state_, examined_, fonts_);
  if (const auto clicked = draw_action_bar(layout.actions, state_, fonts_)) begin(*clicked);
  scrolls_to_choice_ = false;
  if (dialog_.kind != DialogKind::kNone) answer(draw_dialog(width, height, dialog_, fonts_));
}

void StartUi::draw_bar(const Area& area) {
  look::begin_pane("bar", area, look::kPanel);
  look::title("roomradar", look::px(22.0F), fonts_);
  ImGui::AlignTextToFramePadding();
  const float wide = ImGui::GetContentRegionAvail().x - look::px(20.0F);
  if (!work_.empty())
    look::pill(look::kAccent, work_ + " \u2026");
  else if (!state_.message.text.empty())
    look::pill(look::kGood, look::shortened(state_.message.text, wide));
  look::end_pane();
}

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
