// picture_pane.hpp: shows the camera's picture with the virtual objects, and handles the mouse in it.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "app/window/link/ui_channel.hpp"
#include "app/window/panes/gl_texture.hpp"
#include "app/window/panes/theme.hpp"
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

/// Returns a position as in a script: "X Y Z" in metres.
std::string position_words(const Eigen::Vector3d& p_world);

class PicturePane {
 public:
  explicit PicturePane(UiChannel& link) : link_(link) {}

  /// Call for each new snapshot.
  void upload(const Snapshot& shown) { texture_.upload(shown.picture); }
  void draw(const Area& area, const Snapshot& shown, const look::Fonts& fonts, double drop_height_m);
  /// Releases a grabbed object. Call when the pane is not drawn.
  void leave();

  /// Returns the mouse position in the picture, pixels; unset if the mouse is elsewhere.
  [[nodiscard]] const std::optional<Eigen::Vector2d>& pixel() const { return pixel_; }

 private:
  UiChannel& link_;
  GlTexture texture_{/*smooth=*/true};
  std::optional<Eigen::Vector2d> pixel_;
  bool is_down_ = false, was_dragged_ = false;
  /// Mouse position in the window when the button was pressed.
  Eigen::Vector2d pressed_at_ = Eigen::Vector2d::Zero();
  double nearer_m_ = 0.0;
  struct Sample {
    double time_s = 0.0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  };
  std::array<Sample, 8> lately_{};  ///< recent mouse positions, oldest first

  void press_and_drag(const Eigen::Vector2d& pixel, double drop_height_m);
  void turn(const Snapshot& shown);
  [[nodiscard]] Eigen::Vector2d velocity_px_s() const;
};

}  // namespace roomradar
