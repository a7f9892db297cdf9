// play_ui.hpp: content of the window, and the actions of keys.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/window/imgui_window.hpp"
#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/model_view.hpp"
#include "app/window/panes/picture_pane.hpp"
#include "app/window/panes/radar_pane.hpp"
#include "app/window/panes/side_panel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/timing_pane.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

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

}  // namespace roomradar
