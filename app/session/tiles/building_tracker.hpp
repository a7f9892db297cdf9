// building_tracker.hpp: localises the camera in a building, and loads the tiles around it.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "app/session/tiles/tile_window.hpp"
#include "mapping/localization/locator.hpp"
#include "mapping/localization/recognise_place.hpp"

namespace roomradar {

/// Tracks the camera as locate() does. Relocalises it in the building by recognise_place(), since the cost of
/// patches and correlative search grows with the building. A recognised place is refused if it looks like
/// another place. The pose of a recognised place is adopted once two conditions hold. The tiles at the place
/// must be loaded. Aligning the frame with the tiles' surface must not move the pose away from the place.
///
/// A tracked pose is supported if depth constrains it and at least 30 % of the measured pixels show loaded
/// surface, or if recognise_place() returns the same place. A doubtful pose is one that is not supported, or
/// that the depth contradicts. The tracker compares a doubtful pose with the result of recognise_place(): at
/// once if the depth contradicts the pose, in the third doubtful frame, and in every fifth frame after it.
/// Poses without support are discarded 0.15 s after the last supported pose, since their error grows with the
/// camera's motion.
class BuildingTracker {
 public:
  /// Throws Error if the config is invalid. `context` must outlive the tracker.
  BuildingTracker(GlContext& context, TileWindowConfig config) : tiles_(context, std::move(config)) {}

  /// Call before each frame. Returns true if the loaded surfaces have changed.
  bool begin_frame(double stamp_s) { return tiles_.begin_frame(stamp_s); }
  /// Localises a frame, and chooses the tiles for its pose or for the recognised place.
  /// @param keyframe_database  keyframes of the whole building, with a complete index; patches are not used
  /// @param dynamic_mask, expected_depth  as in locate()
  Tracking locate(Locator& locator, const Frame& frame, const KeyframeDatabase& keyframe_database,
                  const MaskImage& dynamic_mask, const ExpectedDepth& expected_depth);

  /// Chooses the tiles for a frame that is not localised by locate(), because its pose is known.
  void follow(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
    tiles_.follow(frame, T_world_camera);
  }

  [[nodiscard]] const TileWindow& tiles() const { return tiles_; }
  /// See TileWindow::has_fault().
  [[nodiscard]] bool has_fault() const { return tiles_.has_fault(); }
  std::string take_fault() { return tiles_.take_fault(); }
  /// Numbers of frames in which recognise_place() found a place, and in which the place was ambiguous.
  [[nodiscard]] std::int64_t recognised() const { return recognised_; }
  [[nodiscard]] std::int64_t ambiguous() const { return ambiguous_; }

 private:
  TileWindow tiles_;
  std::int64_t recognised_ = 0, ambiguous_ = 0;
  int doubtful_frames_ = 0;
  bool is_contradicted_ = false;  ///< the depth contradicts the last tracked pose
  /// The contradiction is so clear that only recognise_place() at the same place keeps the pose.
  bool is_refuted_ = false;
  std::optional<double> supported_s_;  ///< stamp of the last frame whose pose was supported
  std::optional<Eigen::Isometry3d>
      T_world_place_;  ///< place recognised in the last frame, if it was untracked

  /// Judges a tracked pose, and counts consecutive frames with a doubtful pose. Returns true if depth
  /// supports the pose.
  bool judge(const Frame& frame, const Tracking& tracking, const DepthImage& expected_m);
  [[nodiscard]] bool is_recheck_due() const;
  /// Returns true if the last supported pose is too old to follow a pose without support.
  [[nodiscard]] bool is_support_outdated(double stamp_s) const;
};

}  // namespace roomradar
