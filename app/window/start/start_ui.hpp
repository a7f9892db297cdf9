// start_ui.hpp: content of the start view, and the actions of its keys.
#pragma once
#include <functional>
#include <string>

#include "app/start/background_jobs.hpp"
#include "app/start/doctor.hpp"
#include "app/start/start_state.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/start/examined_maps.hpp"
#include "app/window/start/start_dialog.hpp"
#include "app/window/start/start_layout.hpp"

namespace roomradar {

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

}  // namespace roomradar
