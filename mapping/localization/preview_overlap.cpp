// preview_overlap.cpp: projects the depth pixels of one preview into the other.
#include "mapping/localization/preview_overlap.hpp"

#include <cmath>

namespace roomradar {

PreviewOverlap compare_previews(const MapKeyframe& from, const MapKeyframe& to,
                                const Eigen::Isometry3d& T_to_from, double tolerance_m) {
  constexpr int kStep_px = 4;
  constexpr double kMax_m = 4.0;  // noise grows beyond
  PreviewOverlap overlap;
  for (int y = kStep_px / 2; y < from.preview_depth_mm.height; y += kStep_px)
    for (int x = kStep_px / 2; x < from.preview_depth_mm.width; x += kStep_px) {
      const double depth_m = 1e-3 * from.preview_depth_mm.at(x, y);
      if (depth_m <= 0.0 || depth_m > kMax_m) continue;
      ++overlap.valid;
      const Eigen::Vector3d p = T_to_from * back_project(from.preview_camera, x, y, depth_m);
      if (p.z() < 0.3) continue;
      const Eigen::Vector2d at = project(to.preview_camera, p).array().round();
      if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < to.preview_depth_mm.width &&
            at.y() < to.preview_depth_mm.height))
        continue;
      const double other_m =
          1e-3 * to.preview_depth_mm.at(static_cast<int>(at.x()), static_cast<int>(at.y()));
      if (other_m <= 0.0) continue;
      const double gate_m = 0.06 + 0.03 * p.z() + tolerance_m;
      if (std::abs(other_m - p.z()) < gate_m)
        ++overlap.same;
      else if (other_m > p.z() + gate_m)
        ++overlap.through;
    }
  return overlap;
}

}  // namespace roomradar
