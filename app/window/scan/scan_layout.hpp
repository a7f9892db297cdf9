// scan_layout.hpp: divides the scan window into panes.
#pragma once
#include "app/window/panes/window_layout.hpp"

namespace roomradar {

struct ScanLayout {
  Area bar, camera, model, counts;
};

/// Returns the panes of a scan window of this size: the camera's picture beside the model, or above it in a
/// window that is higher than wide.
/// @param scale  scale of the screen; 1 at 96 dpi
constexpr ScanLayout scan_layout(float width, float height, float scale = 1.0F) {
  const float bar = scale * 48.0F, counts = scale * (width < scale * 1000.0F ? 92.0F : 64.0F);
  const float left = std::max(height - bar - counts, 0.0F);
  ScanLayout layout;
  layout.bar = {0.0F, 0.0F, width, bar};
  layout.counts = {0.0F, bar + left, width, counts};
  if (width >= left) {
    layout.camera = {0.0F, bar, 0.5F * width, left};
    layout.model = {0.5F * width, bar, 0.5F * width, left};
  } else {
    layout.camera = {0.0F, bar, width, 0.5F * left};
    layout.model = {0.0F, bar + 0.5F * left, width, 0.5F * left};
  }
  return layout;
}

}  // namespace roomradar
