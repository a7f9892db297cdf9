// foreground_judge.hpp: scores the foreground mask of simulated movers against their true masks.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "dynamic/foreground/foreground.hpp"

namespace roomradar::test {

/// Pixel counts over frames. Only pixels with live depth count, since the mask is undefined elsewhere.
struct MaskScore {
  std::size_t frames = 0;
  std::size_t valid = 0;
  std::size_t both = 0;    ///< marked, and truly moved
  std::size_t missed = 0;  ///< truly moved, not marked
  std::size_t false_ = 0;  ///< marked, not truly moved

  [[nodiscard]] double iou() const {
    const std::size_t either = both + missed + false_;
    return either == 0 ? 1.0 : static_cast<double>(both) / static_cast<double>(either);
  }
  [[nodiscard]] double false_fraction() const {
    return valid == 0 ? 0.0 : static_cast<double>(false_) / static_cast<double>(valid);
  }
};

inline void add_frame(const DepthImage& depth_m, const MaskImage& marked, const MaskImage& truth,
                      MaskScore& score) {
  ++score.frames;
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i) {
    if (!(depth_m.pixels[i] > 0.0F)) continue;
    const bool is = marked.pixels[i] != 0;
    const bool should = truth.pixels[i] != 0;
    ++score.valid;
    score.both += is && should;
    score.missed += !is && should;
    score.false_ += is && !should;
  }
}

/// Renders the depth of a perfect mesh of the room from a pose: exact, 0 without a surface.
inline void cast_room(const Room& room, const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                      ViewCaster& caster, DepthImage& depth_m) {
  caster.prepare(room.solids, camera, T_world_camera);
  depth_m.resize(camera.width_px, camera.height_px, 0.0F);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x)
      depth_m.at(x, y) = static_cast<float>(caster.cast(x, y).depth_m);
  }
}

/// Returns a pose error of `shift_m` and `turn_deg`; `turn` (any number) selects the direction of both.
inline Eigen::Isometry3d pose_error(double shift_m, double turn_deg, int turn) {
  const Eigen::Vector3d axis =
      Eigen::Vector3d(std::sin(1.0 + turn), std::cos(2.3 * turn), std::sin(4.1 * turn)).normalized();
  Eigen::Isometry3d error(
      Eigen::AngleAxisd(turn_deg * M_PI / 180.0, axis.cross(Eigen::Vector3d(0.3, -0.5, 0.8)).normalized()));
  error.pretranslate(axis * shift_m);
  return error;
}

/// Compares every `step`-th frame of the simulated recording with the exact room, rendered from a pose with
/// an error of shift_m and turn_deg.
inline MaskScore judge_foreground(const SimOptions& options, std::int64_t step, double shift_m,
                                  double turn_deg, const ForegroundConfig& config = {}) {
  SimulatedSource source(options);
  ViewCaster caster;
  Frame frame;
  DepthImage expected_m;
  ForegroundState state;
  LabelImage labels;
  MaskImage dynamic_mask;
  MaskScore score;
  for (std::int64_t i = 0; i < options.frames; i += step) {
    source.seek(i);
    if (source.next(frame).status != ReadStatus::kFrame) break;
    const Eigen::Isometry3d T_world_camera =
        source.truth().T_world_camera * pose_error(shift_m, turn_deg, static_cast<int>(i));
    cast_room(source.room(), frame.depth_camera, T_world_camera, caster, expected_m);
    mark_foreground({frame.depth_m, frame.depth_camera, T_world_camera}, expected_m, config, state, labels,
                    dynamic_mask);
    add_frame(frame.depth_m, dynamic_mask, source.truth().moved, score);
  }
  return score;
}

}  // namespace roomradar::test
