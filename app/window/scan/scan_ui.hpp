// scan_ui.hpp: content of the scan window, and the actions of its keys.
#pragma once
#include <optional>
#include <string>

#include "app/cli/options/prescan_options.hpp"
#include "app/scan/scan_channel.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/panes/gl_texture.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/scan/live_model_view.hpp"
#include "app/window/scan/scan_layout.hpp"

namespace roomradar {

/// Draws the scan window and handles its keys. All calls must come from the window's thread.
class ScanUi final : public WindowContent {
 public:
  ScanUi(ScanChannel& channel, const look::Fonts& fonts, LostSignal lost_signal);

  void take_news() override;
  void press(const Key& key) override;
  void draw(float width, float height) override;
  [[nodiscard]] bool wants_to_quit() const override { return quits_; }

 private:
  ScanChannel& channel_;
  const look::Fonts& fonts_;
  const LostSignal lost_signal_;
  ShownScan shown_;
  ScanStage stage_;
  ScanOutcome outcome_;
  GlTexture picture_{/*smooth=*/true}, tint_{/*smooth=*/true};
  LiveModelView model_;
  double newest_s_ = -1.0;  ///< time at which the last frame arrived; < 0: none so far
  bool asks_to_discard_ = false, quits_ = false;

  [[nodiscard]] bool is_tracking() const { return stage_.name.empty() && outcome_.text.empty(); }
  void show_result();
  void signal_loss(std::optional<ScanFault> before) const;
  void press_key(int key, int modifiers);
  void draw_bar(const Area& area);
  void draw_picture(const Area& area);
  void draw_advice(const Area& area);
  void draw_next_view(const Area& area);
  void draw_speed(const Area& area);
  void draw_counts(const Area& area);
  void draw_work(const Area& area);
  void draw_question(float width, float height);
};

}  // namespace roomradar
