// window_layout.hpp: divides the window into panes.
#pragma once
#include <algorithm>

namespace roomradar {

/// Rectangle in the window, in pixels from the window's top left corner.
struct Area {
  float x = 0.0F, y = 0.0F, width = 0.0F, height = 0.0F;
  [[nodiscard]] bool empty() const { return width < 8.0F || height < 8.0F; }
};

/// Min size of the window at scale 1 at which no content is clipped.
inline constexpr int kLeastWidth_px = 640, kLeastHeight_px = 480;

/// Returns the scale of text and panes in a window of this size: the wanted scale, or the largest multiple of
/// 1/8 at which the window's content still fits. The result is at least 1, or the wanted scale if that is
/// less than 1.
constexpr float scale_in_window(float wanted, float width, float height) {
  constexpr float kSteps = 8.0F;
  const float most =
      std::min(width / static_cast<float>(kLeastWidth_px), height / static_cast<float>(kLeastHeight_px));
  if (wanted <= most) return wanted;
  return std::max(static_cast<float>(static_cast<int>(kSteps * most)) / kSteps, std::min(wanted, 1.0F));
}

enum class MainView { kCamera, kModels, kBoth };
constexpr int kMainViews = 3;

struct WindowLayout {
  Area bar, camera, models, side, timing, radar;
  bool has_two_rows = false;  ///< true: the bar is too narrow for one row
};

/// Returns the panes of a window of this size. A narrow window has a bar with two rows and a narrower side
/// panel. In a low window, the panes `timing` and `radar` are empty.
/// @param scale  scale of the screen; 1 at 96 dpi
constexpr WindowLayout window_layout(float width, float height, MainView view, float scale = 1.0F) {
  const bool has_two_rows = width < scale * 1240.0F;
  const float bar = scale * (has_two_rows ? 88.0F : 48.0F), side = std::min(scale * 292.0F, 0.42F * width);
  const float strip =
      height < scale * 560.0F ? 0.0F : std::clamp(0.27F * height, scale * 120.0F, scale * 250.0F);
  const float main_width = std::max(width - side, 0.0F);
  const float main_height = std::max(height - bar - strip, 0.0F);
  WindowLayout layout;
  layout.has_two_rows = has_two_rows;
  layout.bar = {0.0F, 0.0F, width, bar};
  layout.side = {main_width, bar, side, height - bar};
  layout.timing = {0.0F, bar + main_height, 0.5F * main_width, strip};
  layout.radar = {0.5F * main_width, bar + main_height, 0.5F * main_width, strip};
  const Area whole{0.0F, bar, main_width, main_height};
  if (view == MainView::kCamera) layout.camera = whole;
  if (view == MainView::kModels) layout.models = whole;
  if (view == MainView::kBoth) {
    layout.camera = {whole.x, whole.y, 0.5F * whole.width, whole.height};
    layout.models = {whole.x + 0.5F * whole.width, whole.y, 0.5F * whole.width, whole.height};
  }
  return layout;
}

/// Returns the start of an interval of this length, shifted as little as possible to lie in low..high. An
/// interval that is too long starts at `low`.
constexpr float shifted_inside(float start, float length, float low, float high) {
  return std::max(std::min(start, high - length), low);
}

/// Returns the largest area with an image's aspect ratio, centred in `area`.
constexpr Area fitted(const Area& area, int image_width_px, int image_height_px) {
  if (image_width_px <= 0 || image_height_px <= 0) return {};
  const float scale = std::min(area.width / static_cast<float>(image_width_px),
                               area.height / static_cast<float>(image_height_px));
  const float width = scale * static_cast<float>(image_width_px);
  const float height = scale * static_cast<float>(image_height_px);
  return {area.x + 0.5F * (area.width - width), area.y + 0.5F * (area.height - height), width, height};
}

}  // namespace roomradar
