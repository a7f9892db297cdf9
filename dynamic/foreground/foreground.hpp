// foreground.hpp: labels the pixels of a depth frame by comparison with the static model.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/connected_components.hpp"
#include "dynamic/foreground/expected_bounds.hpp"
#include "dynamic/foreground/foreground_config.hpp"
#include "dynamic/foreground/foreground_history.hpp"
#include "dynamic/foreground/pixel_evidence.hpp"
#include "dynamic/foreground/unmapped_space.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Typical standard deviation of the difference in inverse depth between model and measurement. Drift of the
/// map, pose errors and sensor distortion cause errors of inverse depth that hardly change with depth. For a
/// Kinect recording and its own map, the value is 0.003 / m (one disparity step of the sensor) from 0.9 m to
/// 3.5 m. For an exact model, it is 0.0005 / m.
inline constexpr float kUsualMisfit_per_m = 0.003F;

struct StaticResidual {
  /// Standard deviation of measured minus expected inverse depth, without sensor noise.
  float misfit_per_m = kUsualMisfit_per_m;
  std::array<int, 256> histogram{};  ///< scratch: differences from 0 to 0.03 / m
};

/// Updates misfit_per_m from one frame. The value rises immediately, falls by 10 % of the difference per
/// frame, and stays within 0.0006 to 0.007 / m. Pixels whose inverse depth differs by 0.03 / m or more are
/// left out as dynamic.
void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, const DepthNoise& noise,
                   StaticResidual& fit);

/// What was learned from earlier frames (regions of the previous frame, surfaces seen outside the map, misfit
/// of the model), and buffers that are reused. A new state has no earlier frame.
struct ForegroundState {
  ForegroundHistory memory;
  UnmappedSpace unmapped;
  StaticResidual fit;

  ExpectedBounds bounds;
  std::vector<std::uint8_t> before;  // `memory` warped into this frame: bits per block
  PixelEvidence evidence;
  ConnectedComponents regions;
  std::vector<std::uint8_t> firm;  // per region of `regions`: has evidence that no flickering edge has
};

struct ForegroundCounts {
  std::size_t valid = 0;  ///< number of pixels with measured depth
  std::size_t moved = 0;
  std::size_t revealed = 0;
  std::size_t not_known = 0;  ///< number of pixels with measured depth that are kNotKnown or kUnmapped
};

/// Compares a depth frame with the static model's depth at the same pose. The two images and the camera must
/// agree in size (asserted).
///
/// @param measured          measured depth; the pose is used to warp what earlier frames showed into this
///                          frame
/// @param expected_depth_m  depth of the static model at the camera pose, same size, 0 = no surface
/// @param state             one per camera; only the first frame of a size allocates
/// @param labels            resized and set
/// @param dynamic_mask      255 where the label is kMoved, else 0; resized and set
///
/// A pixel seeds a dynamic region only if it is clearly nearer than the model at that pixel. In addition, the
/// pixel must be nearer than every model surface within reach, or lie between the surfaces within reach. The
/// reach is the max shift of an edge by pose and map errors. Hence edges shifted by a pose error stay static,
/// and objects between two near edges are found. A region grows from its seeds along the measured surface,
/// over pixels nearer than the model.
///
/// A hole of the model is an area without expected depth. A hole alone is no evidence. In a hole, the depth
/// seen earlier in this run replaces the model: a surface that is nearer is new, and so is one where nothing
/// was measured before. A region can also grow into a hole, over pixels nearer than the model around it. Such
/// pixels are kUnmapped if they belong to a large region that is not dynamic. All other pixels in holes are
/// kNotKnown. In an
/// unmapped view, all pixels are kNotKnown until something moves in it.
///
/// A region is accepted if it is large enough and has a sufficient fraction of strong pixels. Both thresholds
/// are lower where the previous frame had a region. A new region of less than three times min_region_px or
/// min_region_m2 is accepted only if it persists for a second frame. In holes, a region needs a core of
/// evidence 12 pixels wide.
ForegroundCounts mark_foreground(const PosedDepth& measured, const DepthImage& expected_depth_m,
                                 const ForegroundConfig& config, ForegroundState& state, LabelImage& labels,
                                 MaskImage& dynamic_mask);

}  // namespace roomradar
