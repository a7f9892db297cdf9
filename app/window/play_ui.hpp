// play_ui.hpp: all that is seen in the window, and what its keys do.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/model_view.hpp"
#include "app/window/panes/picture_pane.hpp"
#include "app/window/panes/radar_pane.hpp"
#include "app/window/panes/side_panel.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/timing_pane.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// Within Dear ImGui's frames, on the window's thread.
class PlayUi {
 public:
  /// @param meshes     files that can be added beside the built-in teapot
  /// @param budget_ms  of a frame, where it is held to one
  PlayUi(UiChannel& link, const look::Fonts& fonts, const std::vector<std::string>& meshes,
         std::optional<double> budget_ms);

  /// Takes what is new; whether there was anything.
  bool take_news();
  void draw(float width, float height);
  /// @param key        as key_meant() says
  /// @param modifiers  as GLFW names them
  void press(int key, int modifiers = 0);
  /// Whether a key that is held down acts again and again.
  static bool repeats(int key);
  /// Adds what is in a mesh file, and offers it from now on.
  void take_file(const std::string& path);
  [[nodiscard]] bool wants_to_quit() const { return quits_; }

 private:
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
  std::string message_;
  double message_until_s_ = 0.0, newest_s_ = 0.0;
  double rate_from_s_ = 0.0;
  int rate_frames_ = 0;
  double frames_per_s_ = 0.0;

  void count_rate();
  void ask_at_mouse(UserCommandKind kind);
  void add_object();
  void choose_next();
  void set_speed(double speed);
  void draw_bar(const Area& area);
  void draw_state(const Area& area);
  void draw_budget(const Area& area);
  void draw_message(const Area& area);
  void draw_help(float width, float height);
  void draw_waiting(const Area& area);
};

}  // namespace roomradar
