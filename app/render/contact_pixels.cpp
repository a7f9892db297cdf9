// contact_pixels.cpp: compares heights above an object's foot, and softens occlusion elsewhere.
#include "app/render/contact_pixels.hpp"

#include <cmath>

namespace roomradar {

void find_contacts(const Feet& feet, const PixelRect& rect, const DepthImage& real_depth_m,
                   const Image<float>& object_m, const DepthTolerance& tolerance, MaskImage& contact) {
  constexpr float kUneven_m = 0.006F;
  contact.resize(rect.width, rect.height);
  for (const Feet::Plane& plane : feet.planes) {
    for (int y = 0; y < rect.height; ++y) {
      for (int x = 0; x < rect.width; ++x) {
        const float z_m = object_m.at(x, y), real_m = real_depth_m.at(rect.x + x, rect.y + y);
        if (!(z_m > 0.0F && real_m > 0.0F) || contact.at(x, y) == kOnSupport) continue;
        const float rise = plane.up_camera.dot(
            back_project(feet.camera, rect.x + x, rect.y + y, 1.0).cast<float>());  // per metre of depth
        const float level_m = tolerance.constant_m + kUneven_m + tolerance.per_m2 * z_m * z_m;
        if (std::abs(plane.camera_m + rise * z_m) < feet.height_m)
          contact.at(x, y) = std::abs(plane.camera_m + rise * real_m) < level_m ? kOnSupport : kAtFoot;
      }
    }
  }
}

void soften(const Image<float>& hidden, const MaskImage& covered, const MaskImage& contact,
            Image<float>& softened) {
  softened.resize(hidden.width, hidden.height);
  for (int y = 0; y < hidden.height; ++y) {
    for (int x = 0; x < hidden.width; ++x) {
      const float own = hidden.at(x, y);
      const auto at = [&](int u, int v) {
        return covered.contains(u, v) && covered.at(u, v) != 0 ? hidden.at(u, v) : own;
      };
      float sum = 4.0F * at(x, y);
      sum += 2.0F * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1));
      sum += at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
      const std::uint8_t kind = contact.at(x, y);
      const bool is_shown = kind == kOnSupport || (kind == kAtFoot && own < 0.5F);
      softened.at(x, y) = is_shown ? 0.0F : sum / 16.0F;
    }
  }
}

}  // namespace roomradar
