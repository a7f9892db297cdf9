// building_tracker.hpp: localises the camera in a building, and loads the tiles round it.
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

/// Follows the camera as locate() does, but searches the building by recognise_place() instead of patches and
/// shapes, whose cost grows with the building. A recognised place is used once its tiles are loaded and the
/// frame, aligned with their surface, stays at that place. A place that looks like another is refused. A
/// tracked pose that is doubtful is compared with the place that the frame shows: at once if the depth
/// contradicts the pose, else after 3 frames, then every 5 frames.
///
/// A pose is supported if depth constrains it and surface is loaded in a good part of the view, or if the
/// frame shows that place. Others are followed for 0.15 s after the last supported one, then given up: their
/// error grows with the camera's motion.
class BuildingTracker {
 public:
  /// Throws Error if the config is invalid. `context` must outlive the tracker.
  BuildingTracker(GlContext& context, TileWindowConfig config) : tiles_(context, std::move(config)) {}

  /// Call before each frame. Returns true if the loaded surfaces have changed.
  bool begin_frame(double stamp_s) { return tiles_.begin_frame(stamp_s); }
  /// Localises a frame, and chooses the tiles for its pose or for the place that it shows.
  /// @param keyframe_database  of the whole building, with a complete index; patches are not used
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
  /// Numbers of untracked frames whose place was recognised, or refused because another fits as well.
  [[nodiscard]] std::int64_t recognised() const { return recognised_; }
  [[nodiscard]] std::int64_t ambiguous() const { return ambiguous_; }

 private:
  TileWindow tiles_;
  std::int64_t recognised_ = 0, ambiguous_ = 0;
  int doubtful_frames_ = 0;
  bool is_contradicted_ = false;  ///< depth does not agree well with the last tracked pose
  bool is_refuted_ = false;       ///< it agrees so badly that the pose is given up if no place is recognised
  std::optional<double> supported_s_;  ///< stamp of the last frame whose pose was supported
  std::optional<Eigen::Isometry3d>
      T_world_place_;  ///< place recognised in the last frame, if it was untracked

  /// Judges a tracked pose. Counts consecutive frames with a doubtful one: contradicted or not supported.
  /// Returns true if it is supported by depth.
  bool judge(const Frame& frame, const Tracking& tracking, const DepthImage& expected_m);
  [[nodiscard]] bool is_recheck_due() const;
  /// Returns true if the last supported pose is too old to follow a pose without support.
  [[nodiscard]] bool is_support_outdated(double stamp_s) const;
};

}  // namespace roomradar
