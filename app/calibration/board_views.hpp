// board_views.hpp: selects the frames of a recording that show a checkerboard, one per board pose.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/calibration/checkerboard.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Throws Error naming the field, its value and the rule.
void require_valid(const Board& board);

struct DepthSample {
  double x_px, y_px;  ///< in the distorted depth image
  double reported_m;  ///< depth as reported by the sensor
};

struct BoardView {
  std::int64_t frame = 0;
  std::vector<Eigen::Vector2d> corners_px;  ///< in the distorted colour image, row by row
  std::vector<DepthSample> depth;           ///< depth pixels on the board
  /// Unit normal of the board in the colour camera, by the nominal cameras.
  Eigen::Vector3d normal_camera = Eigen::Vector3d::UnitZ();
};

struct BoardViews {
  std::vector<BoardView> views;
  Frame first;                  ///< first frame with colour; provides image sizes and nominal cameras
  std::int64_t frames = 0;      ///< number of frames read
  std::int64_t with_board = 0;  ///< number of frames in which the board was found
  std::int64_t still = 0;       ///< number of frames in which the board was found and hardly moved
  /// One entry per frame that was rejected only because the depth does not fit the board: median ratio of
  /// measured depth to the depth expected from corners and square size. A common ratio other than 1 indicates
  /// a wrong square_m.
  std::vector<double> off_plane_ratios;
};

/// Finds the board's corners with subpixel precision, or returns nothing.
std::optional<std::vector<Eigen::Vector2d>> find_corners(const ColourImage& colour, const Board& board);

/// Reads the source to its end, or until `most` views are found. A frame becomes a view if it meets all of
/// these: the whole board is in the colour image, the board hardly moves (colour and depth are not taken at
/// the same instant), its pose differs from those in all earlier views, and the depth image measures it.
/// Throws Error if the source has no colour.
/// @param progress  called after every frame with the views so far
BoardViews find_board_views(FrameSource& source, const Board& board, std::size_t most,
                            const std::function<void(const BoardViews&)>& progress);

/// Returns the number of views whose board is tilted by 12 degrees or more against the mean of all.
std::size_t count_tilted(const BoardViews& views);

/// Returns what the views so far lack and what to do about it, in a few words: no board of that size, never
/// held still, squares of another size, too few tilted. Empty if nothing is wrong.
std::string advice_on(const BoardViews& views, const Board& board);

/// Returns true if the frames' depth is registered to colour: one camera for both, so their relative pose
/// cannot be estimated.
bool is_registered(const Frame& frame);

}  // namespace roomradar
