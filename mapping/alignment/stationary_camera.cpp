// stationary_camera.cpp: detects that the camera did not move between two images.
#include "mapping/alignment/stationary_camera.hpp"

#include <cmath>

namespace roomradar {

bool is_camera_stationary(const Image<float>& before, const Image<float>& now) {
  constexpr float kEdge = 10.0F;     // grey levels per pixel, well above a camera's noise
  constexpr float kShift_px = 0.2F;  // an edge that moved this far changes a pixel by a fifth of its gradient
  constexpr int kFewest = 300;
  constexpr float kMostPart = 0.6F;
  if (before.width != now.width || before.height != now.height) return false;
  int edges = 0, unmoved = 0;
  for (int y = 1; y + 1 < before.height; ++y) {
    const float* above = before.row(y - 1);
    const float* row = before.row(y);
    const float* below = before.row(y + 1);
    const float* row_now = now.row(y);
    for (int x = 1; x + 1 < before.width; ++x) {
      const float gu = 0.5F * (row[x + 1] - row[x - 1]), gv = 0.5F * (below[x] - above[x]);
      const float squared = gu * gu + gv * gv;
      if (squared < kEdge * kEdge) continue;
      const float change = row_now[x] - row[x];
      ++edges;
      unmoved += change * change < kShift_px * kShift_px * squared ? 1 : 0;
    }
  }
  return edges >= kFewest && static_cast<float>(unmoved) > kMostPart * static_cast<float>(edges);
}

}  // namespace roomradar
